"""Limits and names of joints and links, as all formats treat them."""
