"""The command from-circles: sweeps of one joint at a time, and the arm that they show."""
