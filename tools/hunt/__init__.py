"""Hunt for draws that break derived bounds: `python -m tools.hunt`."""
