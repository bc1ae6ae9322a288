"""What a slow pull gives, and what a line's loops give beside it, by field of `ReducedTest`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from reduction.cycles.product import Loops
from reduction.errors import DataError, FitError
from reduction.line.loops import identify_cycles, identify_run
from reduction.line.product import SlowPull
from reduction.line.pull import MISFIT_NOTED, fit_pull
from reduction.line.quasistatic import quasi_static_of_run
from reduction.line.solve import reasons_in_words
from reduction.pipeline.locate import Located
from reduction.record import Floats, Specimen
from reduction.settings import CycleSettings
from reduction.strain.model import StrainModel


@dataclass(frozen=True)
class PullConditions:
    """What a slow pull cannot tell of itself; None where not stated.

    ``waiting_time`` [s] is that since the last dynamic test, ``waiting`` the laboratory's words
    for it; ``reference_length`` [m] is the length at zero strain, ``reference_tension`` [N] the
    tension at which it was read.
    """

    waiting: str = ""
    waiting_time: float | None = None
    reference_length: float | None = None
    reference_tension: float | None = None


def pull_specimens(
    located: Located,
    strain: Floats,
    tension: Floats,
    conditions: PullConditions,
    *,
    specimens: Sequence[Specimen],
    models: Sequence[StrainModel],
) -> tuple[tuple[SlowPull | None, ...], list[str]]:
    """Load-strain cubic of each specimen of a slow pull; None and a note where it has none.

    A stretch hose has one only where it fits: one that softens, and stiffens again where its
    cords pick up, would be designed by a slope that it has nowhere.
    """
    pulls: list[SlowPull | None] = []
    notes: list[str] = []
    for index, name in enumerate(located.record.specimens):
        length = conditions.reference_length
        if length is None and np.isfinite(models[index].relaxed_length):
            length = models[index].relaxed_length
        try:
            pull = fit_pull(
                located.record.time, strain[index], tension[index], specimen=name,
                reference_tension=conditions.reference_tension,
                reference_length=length,
                waiting_time=conditions.waiting_time, waiting=conditions.waiting,
            )  # fmt: skip
        except (DataError, FitError) as error:
            notes.append(f"{name}: refused: quasi-static spring constant: {error}")
            pulls.append(None)
            continue
        if specimens[index].kind == "stretch hose" and pull.misfit_share > MISFIT_NOTED:
            notes.append(
                f"{name}: refused: quasi-static spring constant: a cubic of strain misses the "
                f"curve of this hose by {pull.misfit_share:.1%} of its strain (rms), more than "
                f"{MISFIT_NOTED:.0%}; the curve stands in the samples, and a comparison with a "
                "predicted hose has its slope"
            )
            pulls.append(None)
            continue
        notes += [f"{name}: {note}" for note in pull.notes]
        pulls.append(pull)
    return tuple(pulls), notes


def parts_of_line(
    loops: Loops, pulls: Sequence[SlowPull | None], settings: CycleSettings
) -> dict[str, Any]:
    """Parameters of the three-parameter line, of each cycle and of the test, and notes."""
    constant, spread, notes = quasi_static_of_run(
        loops, pulls, break_in_cycles=settings.break_in_cycles
    )
    # the amplitudes of a wave that is no sine are not those of its fundamental
    reading = "amplitude" if settings.waveform == "sinusoidal" else "fundamental"
    given: dict[str, Any] = {
        "quasi_static_spring_constant": constant,
        "quasi_static_standard_uncertainty": spread,
        "reading": reading,
    }
    of_test = identify_run(loops, break_in_cycles=settings.break_in_cycles, **given)
    of_cycles = identify_cycles(loops, **given)
    return {
        "line": of_cycles,
        "line_of_test": of_test,
        "quasi_static_standard_uncertainty": spread,
        "line_notes": (*notes, *of_test.notes, *reasons_in_words(of_cycles.reason)),
    }
