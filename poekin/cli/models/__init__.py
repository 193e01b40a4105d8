"""Commands that look at a model or write it: info, axes, compare, validate, dh, emit, urdf, count."""
