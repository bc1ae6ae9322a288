"""Which length a layout states for slack."""

import pytest

from reduction.readers.layout import Layout
from reduction.readers.record_in_si import length_at_slack


def layout(**channel):
    channels = {
        "time": {"column": "t", "unit": "s"},
        "crosshead_position": {"column": "x", "unit": "mm", **channel},
        "tension.1": {"column": "F", "unit": "N"},
    }
    return Layout.model_validate({"format": "delimited", "channels": channels})


TRAVEL = layout(datum="displacement", reference_length="150 cm")


@pytest.mark.parametrize(
    ("layouts", "length"),
    [
        ([TRAVEL], 1.5),
        ([TRAVEL, TRAVEL], 1.5),
        ([layout(datum="displacement", reference_length="1.5 m", reference_tension="0 N")], 1.5),
        ([layout(datum="displacement", reference_length="1.5 m", reference_tension="9 N")], None),
        ([layout(datum="displacement")], None),
        ([layout(datum="pin-to-pin")], None),
        ([TRAVEL, layout(datum="displacement", reference_length="1.6 m")], None),
        ([TRAVEL, layout(datum="pin-to-pin")], None),
        ([], None),
    ],
)
def test_a_length_stated_at_slack_alike_in_all_files_counts(layouts, length):
    assert length_at_slack(layouts) == length
