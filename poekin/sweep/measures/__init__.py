"""Measures of a configuration that cells, histograms and lists keep."""
