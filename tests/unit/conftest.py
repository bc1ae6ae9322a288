"""Reduced tests made by hand, so that archive, tables and report are tested without the stages.

The numbers are arbitrary but distinct: what is under test is that each one arrives at its place.
"""

import shutil
from dataclasses import fields

import numpy as np
import pytest

from reduction import __version__
from reduction.archive.shared_errors import SHARED, SHARED_OF_CHANNELS
from reduction.archive.test_dataset import to_dataset
from reduction.archive.write import write_archive
from reduction.record.contributions import Component, Contributions, InstrumentErrors, LineSpread
from reduction.record.measurement import Quality, Record, Source, Specimen, Step
from reduction.record.notes import Note
from reduction.stages.channel_lag import LagEstimate
from reduction.stages.cycles.cycle_product import Cycles, Loops
from reduction.stages.holds.hold_product import HoldResult
from reduction.stages.moduli.modulus_product import (
    AmplitudeSummary,
    CycleIdentity,
    ElastomerFit,
    EndModuli,
    ModulusCurves,
    PeakTrend,
    Ratio,
    Segments,
    Slips,
)
from reduction.stages.moduli.slack_length import SlackStrain
from reduction.stages.moduli.stepwise_test import StepwiseResult
from reduction.stages.reduced_test import History, ReducedTest, TestDescription
from reduction.stages.standstills import Standstills
from reduction.stages.strain.strain_model import StrainModel
from reduction.stages.three_parameter_line.hold_pairs import (
    CreepOfHold,
    HeldPair,
    _static_stiffness,
)
from reduction.stages.three_parameter_line.line_product import LineParameters
from reduction.stages.three_parameter_line.rope_programme import (
    BeddingIn,
    CyclesToFailure,
    DynamicStiffness,
    RopeStep,
    TensilePull,
)
from reduction.stages.three_parameter_line.slow_pull import fit_pull
from reduction.uncertainty.errors_of_cycles import with_shared_steps

N_SAMPLES, N_CYCLES, N_BINS, N_SEGMENTS = 60, 4, 5, 3
SOURCE = Source("T-1.csv", "ab" * 32, 12345)
STAGE_LINES = (Step("ingest", "read 61 rows"), Step("cycles", "4 cycles, band 0.02 m"))
SYNTHETIC = {
    "title": "Cycle tests of a new and a used tether",
    "institution": "A laboratory",
    "source": "from a known law",
    "references": "WHOI-2005-10",
    "license": "CC0-1.0",
    "synthetic": "yes",
    "machine": "tether machine",
}


def array(rng, *shape):
    """Distinct positive numbers."""
    return np.round(1 + rng.random(shape) * 100, 6)


def describe(test_id="T-1", kind="cyclic", order=1, attributes=None):
    return TestDescription(
        campaign_id="tmt",
        test_id=test_id,
        kind=kind,
        control="position",
        waveform="triangular",
        order=order,
        attributes=SYNTHETIC if attributes is None else attributes,
    )


def make_record(rng, specimens, test_id="T-1"):
    flags = np.zeros((len(specimens), N_SAMPLES), dtype=np.uint16)
    flags[0, 3] = Quality.MISSING | Quality.SPIKE
    tension = array(rng, len(specimens), N_SAMPLES)
    tension[0, 3] = np.nan
    position_flags = np.zeros(N_SAMPLES, dtype=np.uint16)
    position_flags[:2] = Quality.GAP
    return Record(
        test_id=test_id,
        specimens=specimens,
        time=np.arange(N_SAMPLES) * 0.1,
        crosshead_position=array(rng, N_SAMPLES),
        tension=tension,
        quality_flag=flags,
        crosshead_position_quality_flag=position_flags,
        cycle_counter=np.arange(N_SAMPLES) // 15,
        n_rows_read=N_SAMPLES + 1,
        tension_standard_uncertainty=(2.2, float("nan"))[: len(specimens)],
        position_standard_uncertainty=0.0015,
        metadata={"operator": "größe"},
        notes=(Note("fixture", "note", text="one row left out of the account"),),
    )


def make_cycles():
    starts = np.arange(N_CYCLES) * 15
    first = np.column_stack([starts, starts + 7])
    branch = np.tile(np.repeat([1, 2], [7, 8]), N_CYCLES).astype(np.int8)
    return Cycles(
        first=starts,
        last=starts + 14,
        branch_first=first,
        branch_last=first + 6,
        plateau_rate=np.full((N_CYCLES, 2), 0.3),
        cycle_number=np.repeat(np.arange(1, N_CYCLES + 1), 15).astype(np.int32),
        branch=branch,
        is_in_trimmed_branch=np.ones(N_SAMPLES, dtype=bool),
        band=0.02,
        notes=(Note("fixture", "warning", text="the last cycle is broken"),),
    )


def make_loops(rng, n_specimens):
    names = [item.name for item in fields(Loops) if item.name != "uncertainty"]
    values = {name: array(rng, n_specimens, N_CYCLES) for name in names}
    bare = {"cycle_start_time", "tension_turn_missed", "strain_turn_missed", "energy_turn_missed"}
    uncertain = [name for name in names if name not in bare]
    return Loops(
        **values, uncertainty={name: array(rng, n_specimens, N_CYCLES) for name in uncertain}
    )


def make_curves(rng, n_specimens):
    shape = (n_specimens, 2, N_BINS)
    centres = 0.1 + 0.05 * np.arange(N_BINS)
    values = {
        item.name: array(rng, *shape)
        for item in fields(ModulusCurves)
        if item.name.startswith(("tangent_modulus", "branch_tension"))
        and "by_cycle" not in item.name
    }
    values["tangent_modulus"][0, 0, 0] = np.nan
    values["tangent_modulus_count"] = np.full(shape, N_CYCLES)
    return ModulusCurves(
        strain_bin=centres,
        strain_bin_bounds=np.column_stack([centres - 0.025, centres + 0.025]),
        window=0.2,
        selected_cycle=np.array([1, 4]),
        tangent_modulus_by_cycle=array(rng, n_specimens, 2, 2, N_BINS),
        tangent_modulus_by_cycle_standard_uncertainty=array(rng, n_specimens, 2, 2, N_BINS),
        notes=(Note("fixture", "note", text="few samples in the window"),),
        alignment_strain=np.linspace(0.2, 0.3, n_specimens),
        **values,
    )


def make_hold(rng, specimen, start_time, kind="relaxation", n_terms=2):
    numbers = {item.name: float(array(rng)) for item in fields(HoldResult) if item.type == "float"}
    numbers["hold_start_time"] = start_time
    return HoldResult(
        specimen=specimen,
        kind=kind,
        times=np.array([1.0, 10.0, 60.0]) if n_terms else np.array([1.0, 30.0]),
        tension_at_time=array(rng, 3 if n_terms else 2),
        strain_at_time=array(rng, 3 if n_terms else 2),
        prony_tension=array(rng, n_terms),
        prony_tension_standard_uncertainty=array(rng, n_terms),
        prony_time=array(rng, n_terms),
        prony_time_standard_uncertainty=array(rng, n_terms),
        prony_fraction_at_ramp_end=array(rng, n_terms),
        criterion="corrected Akaike",
        refusals=()
        if n_terms
        else (
            Note("fixture", "refusal", text="Prony series not given: the hold lasts 25 s"),
            Note("fixture", "refusal", text="rate not given: too short"),
        ),
        notes=(Note("fixture", "note", text="ramp of 4 s left out"),),
        **numbers,
    )


def make_model(rng, specimen):
    names = ("relaxed_free_length", "relaxed_splice_length", "splice_compliance", "splice_exponent")
    spread = array(rng, 4, 4)
    return StrainModel(
        specimen=specimen,
        method="tension-driven",
        coefficients={name: float(array(rng)) for name in names},
        covariance=spread @ spread.T,
        position_low=3.0,
        position_high=7.0,
        tension_low=80.0,
        tension_high=900.0,
        marks_from="pooled over the campaign",
        mark_test=("T-1", "T-2"),
        mark_hold=("min", "max"),
        mark_position=array(rng, 2),
        mark_strain=array(rng, 2),
        mark_tension=array(rng, 2),
        mark_strain_residual=array(rng, 2),
        strain_slope_ratio=0.86,
        notes=(Note("fixture", "note", text="constant-fraction reads 14 % high"),),
    )


def make_ratio(rng):
    return Ratio(
        numerator="new",
        denominator="used",
        strain_bin=np.array([0.15, 0.2, 0.25]),
        ratio=array(rng, 2, 3),
        ratio_standard_uncertainty=array(rng, 2, 3),
        ratio_low=array(rng, 2, 3),
        ratio_high=array(rng, 2, 3),
        is_different=np.array([[True, False, True], [False, False, True]]),
        notes=(Note("fixture", "note", text="different test histories"),),
    )


def make_elastomers(specimen):
    return (
        ElastomerFit(
            specimen=specimen,
            law="neo-hookean",
            parameters={"shear_modulus": 3.1e5},
            standard_uncertainty={"shear_modulus": 1.1e3},
            rms_stress=2.0e3,
            strain_low=0.1,
            strain_high=1.2,
            is_stable=True,
            aicc=-12.5,
        ),
        ElastomerFit(
            specimen=specimen,
            law="ogden-2",
            parameters={"modulus_1": 2e5, "exponent_1": 1.4},
            standard_uncertainty={"modulus_1": 3e3, "exponent_1": 0.02},
            rms_stress=1.5e3,
            strain_low=0.1,
            strain_high=1.2,
            is_stable=False,
            aicc=-15.5,
            notes=(Note("fixture", "note", text="unstable in equibiaxial extension"),),
        ),
    )


def make_slips(rng):
    return Slips(
        specimen=("new", "new"),
        slip_cycle=np.array([2, 3]),
        slip_cycle_low=np.array([1, 3]),
        slip_cycle_high=np.array([2, 4]),
        slip_tension_step=-array(rng, 2),
        slip_tension_step_standard_uncertainty=array(rng, 2),
        slip_length=array(rng, 2),
        slip_length_standard_uncertainty=array(rng, 2),
        creep_per_cycle=-array(rng, 2),
        notes=(Note("fixture", "note", text="resolution 0.5 N"),),
    )


def make_specimens():
    new = Specimen(
        "new",
        material="Natsyn rubber",
        condition="new",
        construction="extruded",
        diameter=(0.0264, 0.0265),
        stretched_diameters=((0.1, 0.0252), (1.0, 0.0187)),
        rated_break_strength=3558.0,
        rated_break_strength_source="maker",
        linear_density=0.9,
        wet_linear_density=0.2,
        notes=("printed 1.01 in",),
    )
    return new, Specimen("used", diameter=(0.0239,), condition="used")


def make_line(rng, *shape):
    arrays = {
        item.name: array(rng, *shape)
        for item in fields(LineParameters)
        if item.name not in ("reason", "reading", "notes") and not item.name.endswith("uncertainty")
    }
    spread = {name: array(rng, *shape) for name in arrays}
    return LineParameters(
        **arrays, reason=np.full(shape, 6, np.int8), random_uncertainty=spread,
        shared_uncertainty=spread, uncertainty=spread,
    )  # fmt: skip


def make_pull(rng):
    load = np.linspace(0, 2000.0, 400)
    return fit_pull(
        np.arange(400.0), load / 4e4 + rng.normal(0, 1e-5, 400), load, specimen="new",
        waiting_time=86400.0, waiting="24 h", reference_tension=5.0, reference_length=3.0,
    )  # fmt: skip


@pytest.fixture(scope="session")
def rich_test():
    """Every part filled, two specimens."""
    rng = np.random.default_rng(20051210)
    specimens = make_specimens()
    per_cycle = (2, N_CYCLES)
    segments = {
        item.name: array(rng, 2, 2, N_SEGMENTS)
        for item in fields(Segments)
        if item.name != "criterion"
    }
    for values in segments.values():
        values[1, 1, 2] = np.nan
    of_test = [i.name for i in fields(AmplitudeSummary) if i.name != "uncertainty"]
    return ReducedTest(
        description=describe(),
        specimens=specimens,
        record=make_record(rng, ("new", "used")),
        sources=(SOURCE, Source("T-1b.csv", "cd" * 32, 99)),
        stage_lines=STAGE_LINES,
        settings_json='{"cycles": {"band": null}}',
        notes=(
            Note("fixture", "note", text="=1+1 looks like a formula"),
            Note("fixture", "warning", text="the last cycle is broken"),
        ),
        history=History(
            (("T-0", "T-00"), ()),
            np.array([1.2, np.nan]),
            np.array([400.0, np.nan]),
            np.array([20.0, 0.0]),
            np.array([0.02, np.nan]),
            np.array([0.001, np.nan]),
            np.array([1e-5, np.nan]),
            np.array([0.0, 0.0]),
            np.array([1e6, np.nan]),
        ),
        standstills=Standstills(
            first=np.array([0, 30]),
            last=np.array([5, 40]),
            start_time=np.array([0.0, 3.0]),
            end_time=np.array([0.5, 4.0]),
            mean_position=array(rng, 2),
            mean_tension=array(rng, 2, 2),
            is_rest=np.array([True, False]),
            position_tolerance=0.004,
            slack_tension=8.0,
            tension_tolerance=2.0,
        ),
        phase=np.repeat([0.0, 1.0, 2.0, 3.0], N_SAMPLES // 4),
        strain=array(rng, 2, N_SAMPLES),
        strain_standard_uncertainty=np.array([0.0021, 0.0034]),
        nominal_stress_standard_uncertainty=np.array([4000.0, np.nan]),
        strain_models=(make_model(rng, "new"), make_model(rng, "used")),
        cycles=make_cycles(),
        loops=make_loops(rng, 2),
        curves=make_curves(rng, 2),
        first_loading=make_curves(rng, 2),
        segments=Segments(**segments, criterion="corrected Akaike"),
        end_moduli=EndModuli(
            array(rng, 2, N_CYCLES),
            array(rng, 2, N_CYCLES),
            array(rng, 2, N_CYCLES, 2),
            array(rng, 2, N_CYCLES, 2),
        ),
        identity=CycleIdentity(
            array(rng, *per_cycle),
            array(rng, *per_cycle),
            array(rng, *per_cycle),
            array(rng, 2),
            array(rng, 2),
            (Note("fixture", "warning", text="new: the identity leaves 2 %"),),
        ),
        amplitude=AmplitudeSummary(
            **{name: array(rng, 2) for name in of_test},
            uncertainty={name: array(rng, 2) for name in of_test},
        ),
        line=make_line(np.random.default_rng(1), 2, N_CYCLES),
        line_of_test=make_line(np.random.default_rng(2), 2),
        quasi_static_standard_uncertainty=np.array([10.0, 20.0]),
        line_notes=(Note("fixture", "note", text="new: no slow pull"),),
        channel_lag=LagEstimate(
            np.array([0.02, np.nan]),
            np.array([0.003, np.nan]),
            np.array([19, 2]),
            np.array([0, 1]),
        ),
        line_spread=LineSpread(
            np.array([1, 2]),
            np.array([0.0, 0.01]),
            *(
                {
                    name: np.array([scale, 2 * scale])
                    for name in (
                        "dissipation_spring_constant",
                        "relaxation_time",
                        "dashpot_coefficient",
                    )
                }
                for scale in (1.0, 10.0, 20.0)
            ),
        ),
        pulls=(make_pull(np.random.default_rng(3)), None),
        rope_step=make_rope_step(np.random.default_rng(4)),
        trend=PeakTrend(
            **{item.name: array(rng, 2) for item in fields(PeakTrend)[:5]},
            peak_tension_change_standard_uncertainty=np.array([0.01, 0.02]),
            mean_strain_per_decade=np.array([0.002, 0.003]),
            mean_strain_per_decade_standard_uncertainty=np.array([1e-4, 2e-4]),
            mean_strain_drift=np.array([0.004, 0.005]),
            mean_strain_drift_standard_uncertainty=np.array([2e-4, 3e-4]),
        ),
        slips=make_slips(rng),
        ratios=(make_ratio(rng), make_ratio(rng)),
        elastomers=make_elastomers("new"),
        holds=(
            make_hold(rng, "new", 10.0),
            make_hold(rng, "used", 30.0, n_terms=0),
            make_hold(rng, "new", 20.0, "creep"),
        ),
        stress_at_strain=array(rng, 2, 2),
        stress_at_strain_standard_uncertainty=array(rng, 2, 2),
        stress_at_strain_levels=(1.0, 0.5),
        slack_strain=SlackStrain(
            np.array([0.02, np.nan]),
            np.array([0.001, np.nan]),
            np.zeros(2),
            np.zeros(2),
            ("", "no slack"),
        ),
        contributions=make_contributions(np.random.default_rng(5)),
        shared_uncertainty_of_cycles={"apparent_spring_constant": np.full(per_cycle, 3.0)},
    )


def make_contributions(rng):
    """Two errors of every quantity that has them."""
    size = {
        "specimen": 2, "branch_name": 2, "segment": N_SEGMENTS, "strain_bin": N_BINS,
        "first_loading_strain_bin": N_BINS, "tension_grid": 201, "break_share": 8, "held_pair": 2,
        "pull_term": 4,
        "hold": 3, "hold_time": 4, "prony_term": 2, "strain_level": 2, "comparison": 2,
        "ratio_strain_bin": 3, "slip": 2, "elastomer_parameter": 3, "interval": 2,
    }  # fmt: skip
    values = {
        name: array(rng, 2, *(size[dim] for dim in dims))
        for name, dims in (SHARED | SHARED_OF_CHANNELS).items()
    }
    for name, dims in SHARED.items():
        # the slow pull is one that was fitted: its numbers are read to their uncertainty
        if {"tension_grid", "break_share", "pull_term"} & set(dims):
            values[name] *= 1e-9
    return Contributions(
        (Component("tension_gain", "load cell"), Component("strain_calibration", "new", 1)), values
    )


def make_rope_step(rng):
    """Every part at once, which no test gives."""
    arrays = {BeddingIn: (2,), DynamicStiffness: (2, 1), TensilePull: (2,), CyclesToFailure: (2,)}
    parts = {
        kind: {item.name: array(rng, *shape) for item in fields(kind)}
        for kind, shape in arrays.items()
    }
    parts[DynamicStiffness] |= {
        "level": np.array([0]), "n_cycles": np.array([[10], [9]]), "notes": (),
    }  # fmt: skip
    parts[CyclesToFailure] |= {
        "cycles": np.array([60, 4000]), "failed": np.array([True, False]), "how": ("fell", "sound"),
    }  # fmt: skip
    parts[TensilePull] |= {"is_break": np.array([True, False]), "how": ("fell", "stopped")}
    found = _static_stiffness(
        np.arange(1.0, 2000.0), np.full(1999, 300.0), 0.1 + 0.001 * np.log10(np.arange(1.0, 2000.0)),
        low_tension=100.0, low_strain=0.05, reference_time=100.0,
    )  # fmt: skip
    creep = ("new", "used", "new")
    return RopeStep(
        "every step",
        bedding_in=BeddingIn(**(parts[BeddingIn] | {"n_cycles": 20})),
        dynamic=DynamicStiffness(**parts[DynamicStiffness]),
        held=(
            HeldPair("new", 1, 2, 100.0, 300.0, found),
            HeldPair("used", 1, 2, 100.0, 300.0, None, "the upper hold is too short"),
        ),
        creep=tuple(CreepOfHold(name, 0.001, 1e-5, 300.0, 0.3, 0.003, 600.0) for name in creep),
        lasted=CyclesToFailure(**parts[CyclesToFailure]),
        tensile=TensilePull(**parts[TensilePull]),
        notes=(Note("fixture", "note", text="new: the dynamic stiffness has not settled"),),
    )


@pytest.fixture(scope="session")
def holds_only_test():
    """A relaxation test of one specimen without a diameter."""
    rng = np.random.default_rng(7)
    return ReducedTest(
        description=describe("hold", kind="relaxation", order=None),
        specimens=(Specimen("new"),),
        record=make_record(rng, ("new",), "hold"),
        sources=(SOURCE,),
        stage_lines=STAGE_LINES,
        settings_json="{}",
        notes=(),
        holds=(make_hold(rng, "new", 10.0, n_terms=0),),
    )


@pytest.fixture(scope="session")
def bare_test():
    """A log of which nothing could be made, with few attributes and no slip found."""
    rng = np.random.default_rng(8)
    record = make_record(rng, ("new",), "bare")
    return ReducedTest(
        description=describe("bare", attributes={}),
        specimens=(Specimen("new", diameter=(0.02,)),),
        record=Record(
            test_id="bare",
            specimens=("new",),
            time=record.time,
            crosshead_position=record.crosshead_position,
            tension=record.tension,
            quality_flag=record.quality_flag,
            crosshead_position_quality_flag=record.crosshead_position_quality_flag,
            position_is_length=False,
        ),
        sources=(SOURCE,),
        stage_lines=STAGE_LINES,
        settings_json="{}",
        notes=(),
        slips=Slips((), *[np.empty(0, dtype=int)] * 3, *[np.empty(0)] * 4, np.array([np.nan])),
    )


@pytest.fixture(scope="session")
def stepwise_test():
    """Weights hung one after another; no log."""
    rng = np.random.default_rng(9)
    return ReducedTest(
        description=describe("static", kind="stepwise", attributes={"references": "WHOI-2005-10"}),
        specimens=(Specimen("tether", diameter=(0.0257,), gauge_length=0.1556),),
        record=None,
        sources=(SOURCE,),
        stage_lines=STAGE_LINES,
        settings_json="{}",
        notes=(),
        stepwise=StepwiseResult(
            clock=("1130", "1140", "1205"),
            time=np.array([0.0, 600.0, 2100.0]),
            tension=array(rng, 3),
            length=array(rng, 3),
            eye_to_eye_length=np.array([1.0, np.nan, 2.0]),
            printed_strain=array(rng, 3),
            strain=array(rng, 3),
            branch=np.array([1, 1, 2]),
            gauge_length=0.1556,
            gauge_length_standard_uncertainty=0.0002,
            is_inconsistent=np.array([False, True, False]),
            is_creep=np.array([False, True, True]),
            is_odd=np.array([False, False, True]),
            interval_strain=np.array([0.12, 0.17]),
            interval_modulus=np.array([np.nan, 8e5]),
            interval_modulus_standard_uncertainty=array(rng, 2),
            interval_branch=np.array([1, 2]),
            secant_modulus=array(rng, 3),
            secant_modulus_standard_uncertainty=array(rng, 3),
            notes=(Note("fixture", "warning", text="row 1140 disagrees with itself"),),
        ),
        contributions=Contributions(
            (Component("diameter", "old"),), {"interval_modulus": array(rng, 1, 2)}
        ),
    )


@pytest.fixture(params=["rich_test", "holds_only_test", "bare_test", "stepwise_test"])
def any_test(request):
    """Each kind of product in turn."""
    return request.getfixturevalue(request.param)


def write_to(folder, test):
    """Write a reduced test as an archive, as this version does, and give its path."""
    path = folder / f"{test.description.test_id}.nc"
    write_archive(to_dataset(test, version=__version__, command="reduction run"), path)
    return path


@pytest.fixture(scope="session")
def archives(rich_test, holds_only_test, bare_test, stepwise_test, tmp_path_factory):
    """One archive of each kind, for tests that leave them as they are."""
    folder = tmp_path_factory.mktemp("archives")
    weighed = with_shared_steps(stepwise_test, (InstrumentErrors("tether", tension_gain=0.01),))
    tests = (bare_test, holds_only_test, weighed, rich_test)
    return [write_to(folder, test) for test in tests]


@pytest.fixture
def write(tmp_path, archives, bare_test, holds_only_test, rich_test):
    """Write a reduced test as an archive and give its path; those of all tests are copied."""
    bare, holds_only, _, rich = archives
    written = ((bare_test, bare), (holds_only_test, holds_only), (rich_test, rich))

    def write_test(test):
        for known, path in written:
            if known is test:
                return shutil.copyfile(path, tmp_path / path.name)
        return write_to(tmp_path, test)

    return write_test
