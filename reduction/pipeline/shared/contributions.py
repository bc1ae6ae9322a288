"""Errors that a test shares with others, carried to what it gave.

Names of the contributions are those of the variables of the archive; the axis of the specimens
stands behind that of the components.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from reduction.line.product import SlowPull
from reduction.line.pullgrid import BREAK_SHARES, tension_grid
from reduction.pipeline.shared.blocks import blocks_of_cycles, cycles_of_test
from reduction.pipeline.shared.curves import of_curves, of_segments, rise_rates, strain_rates
from reduction.pipeline.shared.cycles import of_cycles, of_ends, of_slips
from reduction.pipeline.shared.holds import of_holds, of_pairs
from reduction.pipeline.shared.loops import of_dynamic_modulus, of_line, of_loops
from reduction.pipeline.shared.material import of_elastomers, of_material
from reduction.pipeline.shared.pulls import PullOrigin, of_pull, of_rest
from reduction.pipeline.shared.ratio import of_ratios
from reduction.product import ReducedTest
from reduction.record import Floats, areas_of
from reduction.samples.blocks import full_like
from reduction.samples.scratch import let_go
from reduction.settings import CycleSettings
from reduction.uncertainty.join import merged, renamed, stacked
from reduction.uncertainty.product import Contributions, InstrumentErrors

# an archive has them for each cycle, not for the means of a test
_OF_CYCLES_ALONE = ("peak_tension", "valley_tension")


def contributions_of_test(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> Contributions | None:
    """What each shared error adds to the curves, segments and means of a test.

    Parameters
    ----------
    test : ReducedTest
        As reduced; its uncertainties are of type A.
    errors : sequence of InstrumentErrors, length n_specimens
        What is stated of the instruments.
    cycles : CycleSettings
        Control and waveform.
    pulls : sequence of SlowPull or None, length n_specimens, optional
        From which the test has its K_0.
    pull_origins : sequence of PullOrigin or None, length n_specimens, optional
        With what each pull was read; the instruments of the test itself where it is not said.

    Returns
    -------
    contributions : Contributions or None
        Shape (n_components, n_specimens, ...); None where no error is shared.
    """
    own = []
    for index, one in enumerate(errors):
        pull = None if pulls is None else pulls[index]
        origin = pull_origins[index] if pull_origins else None
        own.append(merged(list(_of_specimen(test, index, one, cycles, pull, origin))))
    found = stacked(own)
    parts = [
        found,
        *of_holds(test, errors),
        *of_pairs(test, errors),
        *of_slips(test, errors),
        *of_elastomers(test, errors, found),
        *of_ratios(test, found),
    ]
    whole = merged(parts)
    return whole if whole.component else None


def shared_uncertainty_of_cycles(
    test: ReducedTest,
    errors: Sequence[InstrumentErrors],
    *,
    cycles: CycleSettings,
    pulls: Sequence[SlowPull | None] | None = None,
    pull_origins: Sequence[PullOrigin | None] = (),
) -> dict[str, Floats]:
    """Shared standard uncertainty of the quantities of each cycle, shape (n_specimens, n_cycles).

    Parameters
    ----------
    test : ReducedTest
        With loops.
    errors : sequence of InstrumentErrors, length n_specimens
        What is stated of the instruments.
    cycles : CycleSettings
        Control and waveform.
    pulls : sequence of SlowPull or None, length n_specimens, optional
        From which the test has its K_0.
    pull_origins : sequence of PullOrigin or None, length n_specimens, optional
        As in `contributions_of_test`.

    Returns
    -------
    shared : dict of str to ndarray
        By name of the quantity; empty where no error is shared.
    """
    if test.loops is None:
        return {}
    n_specimens, n_cycles = test.loops.mean_tension.shape
    shared: dict[str, Floats] = {}
    for block in blocks_of_cycles(n_cycles):
        part = cycles_of_test(test, block)
        for index, one in enumerate(errors):
            pull = None if pulls is None else pulls[index]
            origin = pull_origins[index] if pull_origins else None
            found = _of_cycles(test, part, index, one, cycles, pull, origin)
            for name in found.values if found.component else ():
                spread = found.shared_standard_uncertainty(name)
                if name not in shared:
                    # a specimen without a slow pull has no line: nothing is known of it
                    shared[name] = full_like(
                        test.loops.mean_tension, np.nan,
                        shape=(n_specimens, n_cycles, *spread.shape[1:]),
                    )  # fmt: skip
                shared[name][index, block] = spread
        let_go(*shared.values())
        test.loops.let_go()
    return shared


def _of_specimen(
    test: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Iterator[Contributions]:
    model = test.strain_models[index]
    area = float(areas_of(test.specimens)[index])
    summary = test.amplitude
    yield from of_material(test, index, errors, model, area)
    yield from of_cycles(test, index, errors, model, cycles, area)
    own = test.pulls[index] if test.pulls else None
    if own is not None:
        strength = test.specimens[index].rated_break_strength
        yield from of_pull(
            own, errors, model, tension=tension_grid(test.pulls), share=np.array(BREAK_SHARES),
            rated_break_strength=strength,
        )  # fmt: skip
    if test.curves is not None:
        rate = strain_rates(test, index, model, cycles)
        yield of_curves(test.curves, "", index, errors, model, area, rate)
        if test.segments is not None:
            yield of_segments(test.curves, test.segments, index, errors, model, area, rate)
    # without an area the curve is one of tension, of which the slope is not kept
    if test.first_loading is not None and np.isfinite(area):
        rate = rise_rates(test, index) if errors.lag else np.zeros((2, 2, 1))
        yield of_curves(test.first_loading, "_first_loading", index, errors, model, area, rate)
    if summary is not None and test.cycles is not None:
        of_loop = of_loops(summary, index, errors, model, test.cycles, cycles)
        yield _named(of_loop, "test_", left_out=_OF_CYCLES_ALONE)
        if np.isfinite(area):
            yield _named(of_dynamic_modulus(of_loop, summary, index, errors, area), "test_")
        if test.line_of_test is not None and pull is not None:
            rest = of_rest(
                pull, origin or PullOrigin(errors, model),
                np.asarray(summary.mean_tension[index]), of_loop,
            )  # fmt: skip
            yield _named(rest, "test_")
            yield _named(of_line(test.line_of_test, summary, index, of_loop, rest), "test_")


def _of_cycles(
    test: ReducedTest,
    part: ReducedTest,
    index: int,
    errors: InstrumentErrors,
    cycles: CycleSettings,
    pull: SlowPull | None,
    origin: PullOrigin | None,
) -> Contributions:
    """Quantities of each cycle of a part of a test; of its line where it has one."""
    if part.loops is None or part.cycles is None or test.cycles is None:
        return Contributions(())
    model = test.strain_models[index]
    of_loop = of_loops(part.loops, index, errors, model, part.cycles, cycles)
    parts = [of_loop]
    if part.end_moduli is not None:
        parts += of_ends(part, index, errors, float(areas_of(test.specimens)[index]))
    if part.line is not None and test.amplitude is not None and pull is not None:
        rest = of_rest(
            pull, origin or PullOrigin(errors, model),
            np.asarray(test.amplitude.mean_tension[index]),
            of_loops(test.amplitude, index, errors, model, test.cycles, cycles),
        )  # fmt: skip
        parts.append(of_line(part.line, part.loops, index, of_loop, rest))
    return merged(parts)


def _named(found: Contributions, prefix: str, *, left_out: Sequence[str] = ()) -> Contributions:
    names = [name for name in found.values if name not in left_out]
    return renamed(found, {name: f"{prefix}{name}" for name in names})
