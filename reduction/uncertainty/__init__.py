"""The effect on each number of errors that samples share."""
