"""Masks of sweeps: samples that count nowhere."""
