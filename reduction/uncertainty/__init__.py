"""What errors that samples share do to each number."""
