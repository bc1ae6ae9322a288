"""A synthetic record of many cycles between two standstills, reduced by nothing but its generator."""

import numpy as np

from reduction.record.measurement import Quality, Record, Source, Specimen, Step
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.reduced_test import ReducedTest, TestDescription

BEFORE, PER_CYCLE, AFTER = 300, 20, 150


def cycles_of(n_cycles, *, before=BEFORE, per_cycle=PER_CYCLE, after=AFTER, rest=0):
    """Cycles of equal length, ``rest`` samples between two of them.

    Without a rest two cycles share the sample at which one turns to the other, which goes by the
    number of the later one.
    """
    first = before + (per_cycle + rest) * np.arange(n_cycles)
    shared = 1 if rest == 0 else 0
    n_samples = before + n_cycles * (per_cycle + rest) - rest + shared + after
    number = np.zeros(n_samples, dtype=np.int32)
    branch = np.zeros(n_samples, dtype=np.int8)
    for place, begin in enumerate(first):
        number[begin : begin + per_cycle] = place + 1
        branch[begin : begin + per_cycle] = np.repeat([1, 2], per_cycle // 2)
    last = first + per_cycle - 1 + shared
    number[last[-1]], branch[last[-1]] = n_cycles, 2
    halves = np.column_stack([first, first + per_cycle // 2])
    return Cycles(
        first=first,
        last=last,
        branch_first=halves,
        branch_last=halves + per_cycle // 2 - 1 + shared,
        plateau_rate=np.ones((n_cycles, 2)),
        cycle_number=number,
        branch=branch,
        is_in_trimmed_branch=number > 0,
        band=0.1,
    )


def long_test(n_cycles=100, *, cycles=None, n_samples=None):
    """Two specimens; every sample of every channel is another number."""
    if cycles is None and n_samples is None:
        cycles = cycles_of(n_cycles)
    n_samples = n_samples or cycles.cycle_number.size
    rng = np.random.default_rng(31)
    flags = np.zeros((2, n_samples), dtype=np.uint16)
    flags[1, ::7] = Quality.RESAMPLED
    record = Record(
        test_id="L-1",
        specimens=("one", "two"),
        time=np.arange(n_samples) / 10,
        crosshead_position=1 + rng.random(n_samples),
        tension=100 * rng.random((2, n_samples)),
        quality_flag=flags,
        crosshead_position_quality_flag=np.zeros(n_samples, dtype=np.uint16),
        cycle_counter=np.arange(n_samples) // 20,
        n_rows_read=n_samples + 2,
    )
    return ReducedTest(
        description=TestDescription(
            "long", "L-1", "fatigue", "position", "triangular", 1, {"synthetic": "yes"}
        ),
        specimens=(Specimen("one", diameter=(0.02,)), Specimen("two", diameter=(0.01,))),
        record=record,
        sources=(Source("L-1.csv", "cd" * 32, 999),),
        stage_lines=(Step("ingest", "read"),),
        settings_json="{}",
        notes=(),
        phase=np.where(np.zeros(n_samples) if cycles is None else cycles.cycle_number > 0, 3, 2),
        strain=rng.random((2, n_samples)),
        cycles=cycles,
    )
