"""What measurements can tell, and what explains those that do not fit."""
