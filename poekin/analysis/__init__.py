"""Tools that look at models: comparison, axes, counting, dexterity, and validation against an oracle."""
