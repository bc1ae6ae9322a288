"""Stage: the three-parameter line from loops and a slow pull; programmes of a rope laboratory."""
