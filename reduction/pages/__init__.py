"""The explorer and the page of design values."""
