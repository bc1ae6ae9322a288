"""Edge: reduced tests to CF netCDF and back."""
