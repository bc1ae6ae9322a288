"""What errors that samples share do to a test: each module feeds its namesake in uncertainty."""
