"""Stages that a change did not touch are not calculated again, and nothing is mistaken."""

from dataclasses import dataclass

import numpy as np
import pytest

from reduction.errors import FitError
from reduction.explore import memory as memory_module
from reduction.explore.memory import Memory
from reduction.pipeline.recall import plainly


@dataclass(frozen=True)
class Settings:
    factor: float
    table: tuple[np.ndarray, ...] = ()


CALLS = []


def scaled(values, *, settings):
    CALLS.append(settings.factor)
    if settings.factor == 0:
        raise FitError("nothing is left")
    return float(np.nansum(values) * settings.factor)


@pytest.fixture(autouse=True)
def calls():
    CALLS.clear()


def test_equal_arguments_give_what_they_gave_and_are_not_calculated_again():
    recall, values = Memory(), np.array([1.0, np.nan, 2.0])
    for _ in range(3):
        assert recall(scaled, values.copy(), settings=Settings(2.0)) == 6.0
    assert CALLS == [2.0]
    assert plainly(scaled, values, settings=Settings(2.0)) == 6.0


@pytest.mark.parametrize(
    ("values", "settings"),
    [
        (np.array([1.0, np.nextafter(2.0, 3.0)]), Settings(2.0)),
        (np.array([1.0, 2.0], dtype=np.float32), Settings(2.0)),
        (np.array([[1.0, 2.0]]), Settings(2.0)),
        (np.array([1.0, 2.0]), Settings(2.0, (np.zeros(1),))),
        (np.array([1.0, 2.0]), Settings(2.0 + 1e-15)),
    ],
)
def test_arguments_that_differ_in_anything_are_calculated(values, settings):
    recall = Memory()
    recall(scaled, np.array([1.0, 2.0]), settings=Settings(2.0))
    recall(scaled, values, settings=settings)
    assert len(CALLS) == 2


def test_the_oldest_is_forgotten():
    recall, values = Memory(most=2), np.ones(3)
    for factor in (1.0, 2.0, 1.0, 3.0, 1.0, 2.0):
        recall(scaled, values, settings=Settings(factor))
    assert CALLS == [1.0, 2.0, 3.0, 2.0]


def test_what_fails_is_tried_again():
    recall = Memory()
    for _ in range(2):
        with pytest.raises(FitError, match="nothing is left"):
            recall(scaled, np.ones(3), settings=Settings(0.0))
    assert len(CALLS) == 2


def test_arguments_as_long_as_a_long_log_are_not_looked_at(monkeypatch):
    monkeypatch.setattr(memory_module, "_MOST_BYTES", 100)
    recall = Memory()
    for _ in range(2):
        recall(scaled, np.ones(3), settings=Settings(1.0, ({"a": [np.ones(20)]},)))
    assert len(CALLS) == 2
