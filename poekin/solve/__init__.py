"""Functions of a chain that solve for its joints."""
