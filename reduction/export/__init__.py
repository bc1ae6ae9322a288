"""Curves and design values in the words of other programs, each with where its numbers are from."""
