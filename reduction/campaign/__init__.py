"""campaign.toml and the files that it names."""
