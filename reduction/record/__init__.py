"""Samples in SI with their flags, and what every stage says of them: errors, notes, settings."""
