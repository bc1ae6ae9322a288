"""Errors that a test shares with others, carried from the instruments to every number."""
