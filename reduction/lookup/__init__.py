"""Design values of a line or tether, published or measured, with interval, range and source."""
