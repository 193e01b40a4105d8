"""Calibration from sweeps of one joint at a time: circle-point analysis, without a nominal model."""
