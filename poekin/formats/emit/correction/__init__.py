"""Non-geometric errors of a calibrated arm as source text: from readings to true joint values."""
