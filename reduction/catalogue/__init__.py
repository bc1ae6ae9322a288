"""Edge: the tests of each campaign in a file beside them, and questions to all of these files."""
