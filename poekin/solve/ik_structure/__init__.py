"""Structure of an arm's inverse kinematics: the family that it belongs to, and why."""
