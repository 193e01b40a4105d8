"""Solutions of many targets in flat arrays: how they were found, and where they lie."""
