"""Rows of screws as they are given: made exact, or refused with the remedy."""
