"""poekin's benchmarks: `python -m benchmarks` measures, compares with the peers and writes the
report.
"""
