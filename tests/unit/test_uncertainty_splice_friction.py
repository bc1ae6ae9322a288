"""What friction in the splices does to a loop and its branches."""

import numpy as np
import pytest

from reduction.record.contributions import InstrumentErrors
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.strain.strain_model import StrainModel
from reduction.uncertainty.errors_of_curves import _friction_on_branches
from reduction.uncertainty.errors_of_cycles import _of_hold
from reduction.uncertainty.propagation import LoopQuantities, loop_contributions

MODEL = StrainModel(
    "new", "tension-driven",
    {"relaxed_free_length": 2.5, "relaxed_splice_length": 1.25, "splice_compliance": 0.2 / 450,
     "splice_exponent": 1.0},
)  # fmt: skip
ERRORS = InstrumentErrors("new", splice_friction=0.05)


def contributions(errors, model):
    """Of a triangular loop between 225 and 675 N, and strains of 0.5 and 1.5."""
    loop = LoopQuantities(
        frequency=np.array([0.1]), mean_tension=np.array([450.0]),
        tension_amplitude=np.array([225.0]), mean_strain=np.array([1.0]),
        strain_amplitude=np.array([0.5]), apparent_spring_constant=np.array([450.0]),
        hysteresis_energy=np.array([20.0]), storage_spring_constant=np.array([450.0]),
        loss_spring_constant=np.array([25.0]), closed_loop_energy=np.array([20.0]),
    )  # fmt: skip
    return loop_contributions(errors, model, loop, waveform="triangular")


def test_a_loop_is_wider_by_the_difference_of_the_branches_over_the_range_of_tension():
    """By hand: the splices' extension over the free length is 0.1 at 450 N, 0.05 at 225 N."""
    found = contributions(ERRORS, MODEL)
    place = [one.source for one in found.component].index("splice_friction")
    moved = {name: float(rows[place, 0]) for name, rows in found.values.items()}
    assert moved["hysteresis_energy"] == pytest.approx(2 * 225.0 * 0.05 * 0.1, rel=1e-6)
    assert moved["strain_amplitude"] == pytest.approx(-0.05 * 0.05 / 2, rel=1e-6)
    assert moved["apparent_spring_constant"] == pytest.approx(450 * 0.00125 / 0.5, rel=1e-6)
    assert moved["mean_tension"] == 0.0
    # a valley ends a way down
    assert moved["foot_strain"] == pytest.approx(0.05 * 0.05, rel=1e-6)


def test_the_zero_of_the_crosshead_is_in_the_strain_of_a_valley():
    """By hand: without splices 5 mm of 2.5 m, at the valley as at the peak."""
    found = contributions(
        InstrumentErrors("rope", position_offset=0.005),
        StrainModel("rope", "gauge-length", {"gauge_length": 2.5, "reference_position": 2.5}),
    )
    assert np.linalg.norm(found.values["foot_strain"]) == pytest.approx(0.002, rel=1e-6)


def test_strain_is_as_the_marks_say_on_the_way_up_and_too_large_on_the_way_down():
    strain = np.linspace(0.5, 1.5, 101)
    tension = np.stack([450.0 * strain, 450.0 * strain])
    away, steeper = _friction_on_branches(ERRORS, MODEL, strain, tension)
    # far from the reversal each branch begins with
    assert away[0, -1] == pytest.approx(0.0, abs=1e-6)
    assert away[1, 0] == pytest.approx(0.05 * 0.05, rel=2e-3)
    # at the reversals both branches meet
    assert away[0, 0] == pytest.approx(0.05 * 0.05)
    assert away[1, -1] == pytest.approx(0.0)
    assert (steeper[1, -5:] < 0).all()
    assert (steeper[0, :5] < 0).all()


@pytest.mark.parametrize(("is_unloading", "moved"), [(True, 0.05 * 0.1), (False, 0.0)])
def test_strain_of_a_hold_has_the_friction_where_it_was_approached_by_unloading(
    is_unloading, moved
):
    """By hand: splices of 1.25 m that are 20 % longer at 450 N, over 2.5 m, known to 5 %."""
    none, at = np.empty(0), np.array([10.0])
    hold = HoldResult(
        "new", "relaxation", 0.0, 600.0, 1.0, 460.0, 450.0, 0.02, 0.0, 0.0, 0.0, at,
        np.array([450.0]), np.array([1.0]), none, none, none, none, np.nan, np.nan,
        is_unloading=is_unloading,
    )  # fmt: skip
    found = _of_hold(hold, ERRORS, MODEL)
    error = {name: np.sum(rows, axis=0) for name, rows in found.values.items()}
    assert error["hold_strain"] == pytest.approx(moved)
    assert error["strain_at_time"] == pytest.approx(moved)
    assert not error["hold_final_tension"].any()


def test_a_specimen_without_splices_has_no_such_error():
    bare = StrainModel("new", "gauge-length", {"reference_position": 0.0, "gauge_length": 1.0})
    away, _ = _friction_on_branches(ERRORS, bare, np.linspace(0, 1, 5), np.ones((2, 5)))
    assert not away.any()
