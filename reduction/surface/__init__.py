"""Stage: designs of experiments, response surfaces over their runs, screening."""
