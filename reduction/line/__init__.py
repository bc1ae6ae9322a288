"""The three-parameter line: slow pull, forward model, inversion, programmes of a rope laboratory."""
