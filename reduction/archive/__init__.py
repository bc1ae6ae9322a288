"""Products: netCDF archives and CSV tables."""
