"""Edge: the tests of all campaigns of a folder in one index, and questions to it."""
