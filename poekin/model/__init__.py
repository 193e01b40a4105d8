"""Models: screws, the serial chain, the tree of links. Frozen data, validated once."""
