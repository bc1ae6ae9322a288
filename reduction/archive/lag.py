"""What the turns of the wave say of the clocks of the channels: variables, and their values."""

from __future__ import annotations

from itertools import chain

from reduction.archive.values import Values
from reduction.archive.variable import Variable, count, flag, measured
from reduction.uncertainty.lag import LAG_REFUSALS, LagEstimate

_S = ("specimen",)

LAG_ROWS: tuple[Variable, ...] = tuple(
    chain(
        measured("channel_lag", _S),
        count("channel_lag_turns", _S),
        flag("channel_lag_refusal", _S, LAG_REFUSALS),
    )
)


def lag_values(estimate: LagEstimate) -> Values:
    """Return what the turns of the wave say of the clocks of the channels."""
    return {
        "channel_lag": estimate.lag,
        "channel_lag_standard_uncertainty": estimate.standard_uncertainty,
        "channel_lag_turns": estimate.n_turns,
        "channel_lag_refusal": estimate.refusal,
    }
