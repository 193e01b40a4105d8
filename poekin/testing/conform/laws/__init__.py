"""The laws that a subject is held to, and the cases they are tried on."""
