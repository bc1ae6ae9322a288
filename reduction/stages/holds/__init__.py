"""Relaxation and creep."""
