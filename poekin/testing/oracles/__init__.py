"""Oracles: code that shares nothing with what it judges."""
