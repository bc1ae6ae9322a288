"""Edge: raw logs in declared layouts to records in SI."""
