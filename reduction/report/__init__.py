"""The report page of a campaign, from its archives."""
