"""What ± means on the page, in the same words wherever it is explained."""

from __future__ import annotations

__all__ = ["plus_minus", "plus_minus_of_steps"]

_CYCLES = "scatter between cycles, noise, regression"
_SHARED = (
    "load-cell calibration, diameter, position scale, splice marks and strain method, lag between"
    " the channels"
)


def plus_minus(found_from: str = _CYCLES, *, left_out: str = _SHARED, mark: str = "±") -> str:
    """Return the sentence: what a standard uncertainty was found from, and what it leaves out.

    Examples
    --------
    >>> plus_minus("tape readings", left_out="position scale")
    '±: one standard uncertainty (k = 1), type A: tape readings. Not in it: position scale.'
    """
    return f"{mark}: one standard uncertainty (k = 1), type A: {found_from}. Not in it: {left_out}."


def plus_minus_of_steps(mark: str = "±") -> str:
    """Return the sentence for a stepwise test, which has readings and no cycles."""
    return plus_minus(
        "scatter of the readings of length and tension",
        left_out="calibration of length and load, diameter, gauge length",
        mark=mark,
    )
