"""What the cycles of a located test give, by field of `ReducedTest`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from reduction.cycles.loops import close_loops
from reduction.moduli.amplitude import summarise_amplitude
from reduction.moduli.compare import compare_cycles
from reduction.moduli.ends import end_moduli
from reduction.moduli.identity import check_identity
from reduction.moduli.segments import find_segments
from reduction.moduli.slip import find_slips
from reduction.moduli.tangent import tangent_curves
from reduction.moduli.tensionlevel import cycle_tension_level
from reduction.moduli.trend import fit_peak_trend
from reduction.pipeline.comparison import compare_specimens
from reduction.pipeline.locate import Located
from reduction.product import History
from reduction.record import Floats, Specimen, areas_of
from reduction.settings import ReductionSettings

# cycles at each end of a long test of which the kept curves are compared
ENDS = 6


def parts_of_cycles(
    located: Located,
    strain: Floats,
    tension: Floats,
    *,
    specimens: tuple[Specimen, ...],
    history: History | None,
    settings: ReductionSettings,
) -> dict[str, Any]:
    """Loops, curves, segments and what follows from them, by field of `ReducedTest`."""
    record, cycles = located.record, located.cycles
    if cycles is None:
        return {}
    area = areas_of(specimens)
    break_in = settings.cycles.break_in_cycles
    loops = close_loops(record.time, tension, strain, cycles, waveform=settings.cycles.waveform)
    amplitude = summarise_amplitude(loops, area=area, break_in_cycles=break_in)
    loops.let_go()
    if np.isnan(area).any():
        # a rope without a diameter has spring constants alone
        return {"loops": loops, "amplitude": amplitude}
    curves = tangent_curves(
        strain, tension, area=area, cycles=cycles, settings=settings.modulus,
        break_in_cycles=break_in,
    )  # fmt: skip
    parts: dict[str, Any] = {
        "loops": loops,
        "curves": curves,
        "segments": find_segments(curves, area=area, settings=settings.modulus),
        "end_moduli": end_moduli(strain, tension, area=area, cycles=cycles),
        "identity": check_identity(
            strain, tension, area=area, cycles=cycles, names=record.specimens
        ),
        "amplitude": amplitude,
        "trend": fit_peak_trend(loops, area=area, break_in_cycles=break_in),
    }
    loops.let_go()
    ratios = compare_specimens(curves, specimens, history)
    if cycles.n_cycles >= settings.slip.minimum_cycles:
        level, slope = cycle_tension_level(
            located.position, tension, cycle_number=cycles.cycle_number,
            branch=cycles.branch, n_cycles=cycles.n_cycles,
        )  # fmt: skip
        parts["slips"] = find_slips(
            loops, specimens=record.specimens, settings=settings.slip,
            tension_level=level, tension_slope=slope,
        )  # fmt: skip
        kept = curves.selected_cycle
        begin = kept[kept <= ENDS].tolist()
        end = kept[kept > cycles.n_cycles - ENDS].tolist()
        for index, name in enumerate(record.specimens):
            ratio = compare_cycles(
                curves, specimen=index, numerator_cycles=end, denominator_cycles=begin
            )
            ratios.append(
                replace(
                    ratio,
                    numerator=f"{name}, {ratio.numerator}",
                    denominator=f"{name}, {ratio.denominator}",
                )
            )
    parts["ratios"] = tuple(ratios)
    loops.let_go()
    return parts
