"""Phases refuse standstills and cycles of another record."""

import numpy as np
import pytest

from reduction.quantities.flags import PHASE_VALUES
from reduction.record.errors import DataError
from reduction.stages.cycles.cycle_product import Cycles
from reduction.stages.cycles.cycle_search import label_phases
from reduction.stages.standstills import Standstills


def standing(first, last):
    some = np.zeros(1)
    return Standstills(
        np.array([first]), np.array([last]), some, some, some, some[None], some > 1, 0.1, 1.0
    )


def cycling(n_samples):
    edge, none = np.array([[0, 2]]), np.zeros(n_samples)
    return Cycles(
        edge[0, :1], edge[0, 1:], edge, edge, np.ones((1, 2)),
        none.astype(np.int32), none.astype(np.int8), none > 0, 0.1,
    )  # fmt: skip


def test_without_cycles_what_does_not_stand_is_approach():
    phase = label_phases(np.arange(5.0), standstills=standing(1, 3), cycles=None)
    assert phase.tolist() == [
        PHASE_VALUES[n] for n in ("approach", "hold", "hold", "hold", "approach")
    ]


def test_a_standstill_beyond_the_record_is_refused():
    with pytest.raises(DataError, match="beyond the record; found sample 9; needed less than 9"):
        label_phases(np.arange(9.0), standstills=standing(3, 9), cycles=None)


def test_cycles_of_another_record_are_refused():
    with pytest.raises(DataError, match="of another record; found 7 samples; needed 9"):
        label_phases(np.arange(9.0), standstills=standing(3, 8), cycles=cycling(7))
