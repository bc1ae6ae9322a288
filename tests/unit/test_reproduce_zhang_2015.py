"""Zhang (2015) again: what comes back, what is wrong, and what cannot be known."""

from collections import Counter

import pytest
from misprinted import verdicts_of_misprints

from reduction.published.printed_cells import cells_of, errata_of
from reduction.published.zhang_2015 import _answers, items

ITEMS = items()
BY_KEY = {item.cell.key: item for item in ITEMS}

# by hand: of Table 7, 40 vertical Airy cells less the four at t = 0, where there is no velocity;
# of Table 5 the four vertical ones; of Table 8 both of P2, the maximum of P3, the averages of P3
# and P4
COUNTS = {
    "1": {"derived": 4, "measured": 3, "open": 1},
    "2": {"measured": 14},
    "3": {"derived": 5},
    "4": {"derived": 3, "erratum": 1, "open": 1},
    "5": {"derived": 4, "erratum": 4},
    "6": {"derived": 8},
    "7": {"derived": 132, "erratum": 36},
    "8": {"derived": 3, "erratum": 5},
}


def test_every_cell_has_its_item_in_its_place():
    assert [item.cell for item in ITEMS] == list(cells_of("Zhang-2015"))


@pytest.mark.parametrize("table", COUNTS)
def test_counts_of_a_table(table):
    assert Counter(one.verdict for one in ITEMS if one.cell.table == table) == COUNTS[table]


def test_nothing_is_unexplained():
    assert Counter(one.verdict for one in ITEMS) == {
        "derived": 189, "erratum": 52, "open": 2, "measured": 18,
    }  # fmt: skip


def test_each_erratum_is_shown_by_a_cell():
    assert {item.cell.erratum for item in ITEMS} - {""} == {
        one.id for one in errata_of("Zhang-2015")
    }


def test_a_changed_digit_is_found():
    verdicts = verdicts_of_misprints("Zhang-2015", _answers())
    assert {key for key, verdict in verdicts.items() if verdict != "unexplained"} == set()
    assert len(verdicts) == 189


@pytest.mark.parametrize(
    ("key", "value", "within"),
    [
        (("3", "floating pipeline", "outer_diameter D"), 114.0, 0.13),
        (("3", "floating pipeline", "wall_thickness d"), 6.0, 0.04),
        (("3", "floating pipeline", "water_density rho1"), 1.025, 0.0005),
        (("3", "floating pipeline", "wall_density rho2"), 1.25, 0.0025),
        (("3", "floating pipeline", "content_density rho3"), 0.83, 0.0006),
        (("4", "level 4 waves", "wave_period T"), 3.663, 0.0005),
        (("4", "level 4 waves", "wave_length L"), 19.90, 0.02),
        (("4", "level 4 waves", "wave_height H"), 1.25, 0.0002),
        (("eq 12", "all examples", "drag_coefficient C_D"), 1.2, 0.0001),
        (("eq 12", "all examples", "inertia_coefficient C_M"), 2.0, 0.0003),
        (("eq 11", "floating pipeline", "immersion_depth h"), 95.124, 0.0005),
        (("eq 11", "floating pipeline", "submerged_section_area S1"), 0.0090994, 5e-8),
        (("sec 5.1", "example of the Airy theory", "water_depth"), 6.0, 0.005),
        (("sec 5.2", "example of the Stokes theory", "water_depth"), 3.0, 0.0005),
        (("sec 3", "velocity and acceleration of the water", "elevation at which they are taken"),
         0.0, 0.11),
        (("8", "average", "P3 (horizontal, Stokes theory)"), 17.1345, 0.0001),
        (("8", "average", "P4 (vertical, Stokes theory)"), 14.1127, 0.0001),
        (("8", "average", "P2 (vertical, Airy theory)"), 10.0, 0.01),
    ],
    ids=lambda one: one[2] if isinstance(one, tuple) else "",
)  # fmt: skip
def test_what_is_recomputed(key, value, within):
    assert BY_KEY[key].recomputed == pytest.approx(value, abs=within)
