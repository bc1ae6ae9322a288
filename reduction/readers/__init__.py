"""A log of any format to a record in SI."""
