"""Forces and torques of arms that stand still."""
