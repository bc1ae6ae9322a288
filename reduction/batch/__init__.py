"""Edge: a whole campaign, test by test; a failed test does not stop the others."""
