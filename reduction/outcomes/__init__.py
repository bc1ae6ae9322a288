"""Outcomes without a log: strength, fatigue, abrasion, exposure."""
