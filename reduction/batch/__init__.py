"""Runs a campaign from its logs to its products."""
