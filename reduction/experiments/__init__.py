"""Designed experiments: response surfaces, screening, outcomes without a log."""
