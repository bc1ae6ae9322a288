"""Whether raw files and products still belong together."""
