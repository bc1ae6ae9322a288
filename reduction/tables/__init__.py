"""Edge: the CSV tables of a campaign, made from its archives alone."""
