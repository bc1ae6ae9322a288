"""Names, units and digits of the numbers that the package gives."""
