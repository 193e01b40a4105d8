"""The fit: initial guess, Gauss-Newton, robust losses, noise."""
