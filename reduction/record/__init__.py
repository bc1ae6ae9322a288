"""Samples in SI with their flags, and the errors, notes and settings common to all stages."""
