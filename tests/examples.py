"""How many examples a property is tried with: a fifth by default, all of them nightly."""

from hypothesis import settings


def examples(number):
    """So many nightly, a fifth of them by default, and never less than five."""
    return max(5, round(number * settings.default.max_examples / 100))
