"""Commands of sweeps: `poekin sweep ...`."""
