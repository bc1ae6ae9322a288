"""What the five reports print, and the same recomputed."""
