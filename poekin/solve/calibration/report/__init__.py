"""What a calibration changed, as a page, as pictures and as a file."""
