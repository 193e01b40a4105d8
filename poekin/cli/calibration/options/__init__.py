"""Options that commands of calibration share: columns of files, and places."""
