"""Coupled readings: joints whose values are sums of what a controller displays."""
