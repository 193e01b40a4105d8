"""The nearest arm whose inverse kinematics has a closed form, and how far away it is."""
