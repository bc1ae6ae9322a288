"""Stage: relaxation at constant length and creep at constant tension."""
