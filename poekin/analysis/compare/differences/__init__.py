"""Differences of two models, joint by joint and convention by convention."""
