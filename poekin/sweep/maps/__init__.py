"""Maps, what they answer, and functions that make them."""
