"""The path of one test from its located record to a reduced test."""
