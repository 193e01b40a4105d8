"""The tree of a robot's links and joints, and the coupling of its joints."""
