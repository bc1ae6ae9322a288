"""Stage: outcomes without a log: strength, fatigue, abrasion, exposure."""
