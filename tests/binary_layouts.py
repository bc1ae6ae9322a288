"""Layouts of the small logs of the tests of binary readers."""

from functools import partial

from reduction.readers.layout import Layout


def layout_of(kind, load="F"):
    """A layout with a time ``t`` and a tension, to be changed by the settings of a test."""
    channels = {
        "time": {"column": "t", "unit": "s"}, "tension": {"1": {"column": load, "unit": "kN"}},
    }  # fmt: skip
    return partial(_layout, {"format": kind, "channels": channels})


def _layout(usual, **settings):
    return Layout.model_validate(usual | settings)
