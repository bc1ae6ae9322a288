"""A campaign from its logs to its products."""
