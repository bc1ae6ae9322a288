"""Errors of load cells at points of the plane, against laws fitted again to wrong tensions."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

from reduction.record.contributions import Component, InstrumentErrors
from reduction.stages.strain.strain_model import StrainModel, _tension_driven_strain
from reduction.uncertainty.error_field import _load_parts

FREE, SPLICES, COMPLIANCE, EXPONENT = 2.55, 1.18, 0.0012, 0.86
MARKS = np.array([0.7, 200.0, 420.0, 600.0, 900.0])  # the first while it was slack
POINTS = np.array([250.0, 480.0, 800.0])
SIZE = {"tension_gain": 1e-4, "tension_offset": 0.05}


def model(cells=(), exponent=EXPONENT):
    compliance = COMPLIANCE * 500.0 ** (EXPONENT - exponent)
    return StrainModel(
        "new", "tension-driven",
        {"relaxed_free_length": FREE, "relaxed_splice_length": SPLICES,
         "splice_compliance": compliance, "splice_exponent": exponent},
        mark_hold=("slack", "min", "centre", "max", "far"), mark_tension=MARKS,
        mark_load_cell=cells,
    )  # fmt: skip


def wrong(force, source, size):
    return force * (1 + size) if source == "tension_gain" else force + size


def refitted(strain, is_wrong, source, size, exponent):
    """Strain of the points by a law fitted to marks of which some are wrong, by curve_fit."""
    known = model(exponent=exponent).coefficients
    splice = known["splice_compliance"] * MARKS[1:] ** exponent
    force = np.where(is_wrong[1:], wrong(MARKS[1:], source, size), MARKS[1:]) / 500
    if exponent == 1.0:
        factor, power = float(force @ splice) / float(force @ force), 1.0
    else:
        (factor, power), _ = curve_fit(
            lambda x, c, n: c * x**n, force, splice, p0=(splice.mean(), exponent), xtol=1e-14,
            ftol=1e-14, gtol=1e-14,
        )  # fmt: skip
    position = FREE * (1 + strain) + SPLICES * (1 + known["splice_compliance"] * POINTS**exponent)

    def at(points):
        return _tension_driven_strain(
            position, points, relaxed_free_length=FREE, relaxed_splice_length=SPLICES,
            splice_compliance=factor / 500**power, splice_exponent=power,
        )  # fmt: skip

    return at


@pytest.mark.parametrize("exponent", [EXPONENT, 1.0])
@pytest.mark.parametrize("source", SIZE)
@pytest.mark.parametrize("cells", [("A",) * 5, ("B",) * 5, ("A", "A", "B", "A", "B")])
def test_each_cell_moves_the_points_that_it_logged_and_the_law_by_its_marks(
    cells, source, exponent
):
    errors = InstrumentErrors("new", tension_instrument="A", **SIZE)
    found = dict(_load_parts(errors, model(cells, exponent), POINTS))
    strain = np.array([0.4, 0.9, 1.2])
    for cell in dict.fromkeys(("A", *cells)):
        of_cell = np.array([one == cell for one in cells])
        ends = []
        for way in (1, -1):
            size = way * SIZE[source]
            at = refitted(strain, of_cell, source, size, exponent)
            ends.append(at(wrong(POINTS, source, size) if cell == "A" else POINTS))
        wanted = (ends[0] - ends[1]) / 2
        rows = found[Component(source, cell)]
        np.testing.assert_allclose(rows[1], wanted, rtol=2e-3, atol=2e-9)
        moved = wrong(POINTS, source, SIZE[source]) - POINTS if cell == "A" else 0.0
        np.testing.assert_allclose(rows[0], moved, atol=1e-12)


def test_a_cell_that_read_no_mark_of_the_law_and_no_sample_is_in_nothing():
    cells = ("C", "A", "A", "A", "A")  # C read the slack specimen, which is no mark of the law
    parts = _load_parts(
        InstrumentErrors("new", tension_instrument="A", **SIZE), model(cells), POINTS
    )
    assert {one.of for one, _ in parts} == {"A"}


def test_a_mark_of_which_no_cell_is_known_was_read_by_that_of_the_samples():
    errors = InstrumentErrors("new", tension_instrument="A", **SIZE)
    unknown = dict(_load_parts(errors, model(("A", "", "B", "", "A")), POINTS))
    named = dict(_load_parts(errors, model(("A", "A", "B", "A", "A")), POINTS))
    assert set(unknown) == set(named)
    assert {one.of for one in unknown} == {"A", "B"}
    for one, rows in named.items():
        np.testing.assert_array_equal(unknown[one], rows)


def test_a_method_that_knows_no_tension_has_the_cell_of_the_samples_alone():
    line = StrainModel(
        "new", "marks", {}, mark_hold=("min",), mark_tension=np.array([300.0]),
        mark_load_cell=("B",),
    )  # fmt: skip
    parts = _load_parts(InstrumentErrors("new", tension_instrument="A", **SIZE), line, POINTS)
    assert {one.of for one, _ in parts} == {"A"}
    assert all(not rows[1].any() for _, rows in parts)


def test_a_wrong_gain_of_the_cell_of_the_marks_leaves_the_strain_of_splices_that_saturate():
    """Marks and samples have one wrong tension: the splices strain what the tape says."""
    saturating = StrainModel(
        "new", "mixed",
        {"relaxed_free_length": FREE, "relaxed_splice_length": SPLICES, "splice_offset": 0.0,
         "splice_strain_ratio": 0.0, "splice_strain_curvature": 0.0, "splice_strain_cubic": 0.0,
         "splice_compliance": 0.0, "splice_exponent": 1.0, "splice_limit": 0.25,
         "splice_saturation": 1 / 300.0},
        mark_hold=("slack", "min", "centre", "max", "far"), mark_tension=MARKS,
        mark_load_cell=("A",) * 5,
    )  # fmt: skip
    parts = {}
    for cell in ("A", "B"):
        errors = InstrumentErrors("new", tension_gain=0.01, tension_instrument=cell)
        parts[cell] = {one.of: rows[1] for one, rows in _load_parts(errors, saturating, POINTS)}
    np.testing.assert_allclose(parts["A"]["A"], 0.0, atol=1e-12)
    reached = POINTS / 300.0
    by_hand = -SPLICES / FREE * 0.25 * reached * np.exp(-reached) * 0.01
    np.testing.assert_allclose(parts["B"]["B"], by_hand, rtol=1e-9)
    np.testing.assert_allclose(parts["B"]["A"], -by_hand, rtol=1e-9)


def test_a_wrong_zero_of_the_cell_is_no_slope_without_bounds_at_a_tension_near_none():
    errors = InstrumentErrors("new", tension_offset=1.0, tension_instrument="B")
    load = np.array([1e-3, 1e-2, 0.1, 0.99])
    parts = {one.of: rows for one, rows in _load_parts(errors, model(("A",) * 5), load)}
    # by as much as the splices strain in one newton, per newton
    law = SPLICES / FREE * COMPLIANCE * EXPONENT * load ** (EXPONENT - 1)
    assert (np.abs(parts["B"][4]) <= 2 * law).all()
    assert (np.abs(parts["B"][1]) <= law * load * 1.001).all()
