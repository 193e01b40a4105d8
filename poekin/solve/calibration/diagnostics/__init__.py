"""Diagnostics: identifiable parameters, and explanations of measurements that do not fit."""
