"""Reversals, cycles, loops and their energy."""
