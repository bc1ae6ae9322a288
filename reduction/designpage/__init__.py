"""The design-value page: every line that can be looked up, on one page that opens from disk."""
