"""Reports of a calibration: changes, page, pictures and file."""
