"""Edge: campaign.toml, its tests and its marks, validated."""
