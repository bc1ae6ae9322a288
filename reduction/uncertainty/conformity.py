"""Whether a number conforms to a limit, by a rule that is stated.

References
----------
.. [1] JCGM 106:2012, "Evaluation of measurement data - The role of measurement uncertainty in
   conformity assessment," 8.2 (simple acceptance), 8.3 (decision rules based on guard bands).
"""

from __future__ import annotations

import math
from typing import Literal

DecisionRule = Literal["simple acceptance", "guard band"]
Verdict = Literal["conforms", "does not conform", "no statement"]


def conformity(
    value: float,
    interval: tuple[float, float],
    *,
    lower: float | None,
    upper: float | None,
    rule: DecisionRule,
) -> Verdict:
    """Return what a rule makes of a number and its limits.

    Parameters
    ----------
    value : float
        The measured one. [any]
    interval : tuple of float
        Ends of its 95 % coverage interval. [as value]
    lower, upper : float or None
        Limits; what lies on one is inside. [as value]
    rule : {"simple acceptance", "guard band"}
        By the first the value alone decides; by the second the whole interval has to lie inside
        the limits, or outside them.

    Returns
    -------
    verdict : Verdict
        No statement where the value, or by a guard band its interval, is not known, and by a
        guard band where the interval reaches over a limit.

    Raises
    ------
    ValueError
        Never by itself.

    Notes
    -----
    Simple acceptance: [1]_, 8.2; a value on a limit is then wrongly judged with a probability up
    to 50 %.  A guard band as wide as the expanded uncertainty on either side of a limit: [1]_,
    8.3.2 and 8.3.3; at most 2.5 % on each side.

    Examples
    --------
    >>> for rule in ("simple acceptance", "guard band"):
    ...     print(conformity(1.02, (0.97, 1.07), lower=1.0, upper=None, rule=rule))
    conforms
    no statement
    """
    low, high = (value, value) if rule == "simple acceptance" else interval
    if math.isnan(low) or math.isnan(high):
        return "no statement"
    bottom = -math.inf if lower is None else lower
    top = math.inf if upper is None else upper
    if bottom <= low and high <= top:
        return "conforms"
    if high < bottom or low > top:
        return "does not conform"
    return "no statement"
