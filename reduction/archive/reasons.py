"""What several schemas say in the same words: why a variable has no uncertainty; yes and no.

A reason stands in the archive beside the variable, as `reduction.archive.variable.stated` has it.
"""

from __future__ import annotations

READING = "a reading: its uncertainty is that of the channel"
CLOCK = "a reading of the clock"
BOUND = "bound"
SETTING = "setting"
STATED = "stated by the laboratory"
STRENGTH = "as stated; what is stated of its error is in the numbers that are shares of it"
AXIS = "axis of the curve"
CHECK = "residual of a check"
CRITERION = "criterion of a fit"
STATISTIC = "a statistic of a test"
SPREAD = "is itself a measure of spread"
OF_UNCERTAINTY = "degrees of freedom of an uncertainty"
PART = "is part of an uncertainty"
MOVEMENT = "what the machine did; no number is made from it"
OF_MARKS = "a reading at the marks: what they are known to is in the coefficients fitted to them"
WHERE_IT_STOOD = "tells standstills apart; what a hold gives has its uncertainty with the hold"
TWO_METHODS = "two methods on the same marks: what they get wrong they share"
SEE_PER_DECADE = "from a part of the cycles; peak_tension_per_decade has one, from all of them"

NO_YES = {"no": 0, "yes": 1}
"""Meanings of a flag that answers a question."""
