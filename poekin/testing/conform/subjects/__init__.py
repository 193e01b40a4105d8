"""Subjects: found by name, declared, and described."""
