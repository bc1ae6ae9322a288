"""Predictions from construction alone: stretch hose, helical armour, wave load."""
