"""Stage: where the crosshead stands still, and what kind of standing it is."""
