"""How a stage is called: plainly, or by one who remembers what equal arguments gave."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, Protocol, TypeVar

__all__ = ["Recall", "plainly"]

Given = ParamSpec("Given")
Result = TypeVar("Result")


class Recall(Protocol):
    """Calls a pure function; the result is what it gives for these arguments."""

    def __call__(
        self, function: Callable[Given, Result], *arguments: Given.args, **named: Given.kwargs
    ) -> Result:
        """Result of the function."""
        ...


def plainly(
    function: Callable[Given, Result], *arguments: Given.args, **named: Given.kwargs
) -> Result:
    """Call a function and remember nothing.

    Examples
    --------
    >>> plainly(round, 2.5678, ndigits=2)
    2.57
    """
    return function(*arguments, **named)
