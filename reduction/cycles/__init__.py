"""Stage: reversals, cycles, branches and closed loops."""
