"""Edge: the HTML report of a campaign, made from its archives alone."""
