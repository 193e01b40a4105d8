"""Effects in residuals: each a cause that a calibration left out, tested for being there."""
