"""Hoses that reach a target, as the command predict hose says them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from reduction.cli.commandoutput import CommandOutput
from reduction.cli.numbers import plain, short, table_of
from reduction.pipeline.hosedesigns import DesignedHose
from reduction.prediction import HoseTarget
from reduction.units import UnitSystem, display_unit


def show_designs(
    designs: Sequence[DesignedHose], target: HoseTarget, output: CommandOutput, system: UnitSystem
) -> None:
    """Print each way to reach a target, and why there is none."""
    force, per_newton = display_unit("N", system)
    small, per_metre = ("in", 1 / 0.0254) if system == "us" else ("mm", 1e3)
    load = "" if target.tension is None else f" and {per_newton * target.tension:.5g} {force}"
    table = table_of(
        "change", "angle [deg]", f"cords [1/{small}]", f"layers [{small}]", f"bore [{small}]",
        f"skin [{small}]", f"ribbon [{small}]", "strain [%]", f"tension [{force}]",
        f"break [{force}]", "break over working",
        title=f"Hoses for {100 * target.strain:.4g} %{load} at the working load",
    )  # fmt: skip
    for one in designs:
        if one.design is None or one.events is None:
            continue
        hose, events = one.design, one.events
        layers = " ".join(short(per_metre * float(value), 4) for value in hose.layer_diameter)
        ribbons = " ".join(dict.fromkeys(short(per_metre * value, 4) for value in one.ribbon_width))
        working, at_break = float(events.working.tension), float(events.cord_break.tension)
        table.add_row(
            one.varied,
            short(float(np.degrees(hose.wrap_angle)), 4),
            short(float(hose.cords_per_length) / per_metre, 4),
            " ".join(dict.fromkeys(layers.split())),
            short(per_metre * float(hose.inner_diameter), 4),
            short(per_metre * float(hose.outer_diameter), 4),
            ribbons,
            short(100 * float(events.working.strain), 4),
            short(per_newton * working),
            short(per_newton * at_break),
            short(at_break / working, 3),
        )
    if table.row_count:
        output.show(table)
    for one in designs:
        if one.refusal:
            output.say(f"no hose by {one.varied}: {one.refusal}")


def designed(one: DesignedHose) -> dict[str, Any]:
    """What ``--json`` says of one way to reach a target, in SI."""
    answer: dict[str, Any] = {"varied": one.varied, "refusal": one.refusal or None}
    if one.design is None or one.events is None:
        return answer
    numbers = (
        "wrap_angle", "layer_diameter", "inner_diameter", "outer_diameter", "cords_per_length",
    )  # fmt: skip
    events = {"pick_up": one.events.pick_up, "working": one.events.working,
              "break": one.events.cord_break}  # fmt: skip
    return answer | {
        **{name: plain(getattr(one.design, name)) for name in numbers},
        "ribbon_width": list(one.ribbon_width),
        "events": {
            name: {"strain": plain(event.strain), "tension": plain(event.tension)}
            for name, event in events.items()
        },
    }
