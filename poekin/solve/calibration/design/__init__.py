"""The choice of configurations to measure at."""
