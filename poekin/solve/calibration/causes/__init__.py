"""Causes of measurements that do not fit, each tried on the data."""
