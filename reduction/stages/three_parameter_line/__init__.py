"""The three-parameter line, slow pulls, rope programmes."""
