"""Choice of non-geometric terms by the error on held-out readings."""
