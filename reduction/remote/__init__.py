"""Edge: whole files copied from the net and to it; fsspec is imported at first use."""
