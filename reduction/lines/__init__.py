"""Design values of lines: look-up, composite curves, assemblies, decks for mooring codes."""
