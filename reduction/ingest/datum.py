"""Where the zero of a displacement is, as far as its layouts say."""

from __future__ import annotations

from collections.abc import Sequence

from reduction.ingest.layout import Layout
from reduction.units import parse_quantity


def length_at_slack(layouts: Sequence[Layout]) -> float | None:
    """Thimble-to-thimble length at which the layouts of a log say that it is slack.

    Parameters
    ----------
    layouts : sequence of Layout
        One a file.

    Returns
    -------
    length : float or None
        ``reference_length`` where it was read at slack; None where none is stated, where it
        was read under tension, or where the files differ. [m]
    """
    lengths = set()
    for layout in layouts:
        channel = layout.channels.get("crosshead_position")
        if channel is None or channel.datum != "displacement" or channel.reference_length is None:
            return None
        if parse_quantity(channel.reference_tension or "0 N", "force") > 0:
            return None
        lengths.add(parse_quantity(channel.reference_length, "length"))
    return lengths.pop() if len(lengths) == 1 else None
