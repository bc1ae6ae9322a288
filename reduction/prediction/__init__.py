"""Hoses, armour and waves from theory, and a measured hose against its prediction."""
