"""Reads logs of any format into records in SI."""
