"""Surfaces come out of their archive as they went in, and are evaluated from the file alone."""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
from experiments import ABOUT, FACTORS, HIGH, LOW, screening_experiment, surface_experiment

from reduction.archive.open import open_archive
from reduction.archive.surfaces_dataset import surface_names, surfaces_of, surfaces_to_dataset
from reduction.archive.write import write_archive
from reduction.experiments.response_surfaces import fit_surfaces
from reduction.experiments.surface_points import evaluate_surfaces
from reduction.quantities.names import RESPONSES
from reduction.record.errors import ArchiveError

RESULTS = (
    surface_experiment(),
    surface_experiment("short", seed=4, names=RESPONSES[:2], missing=(3,)),
    surface_experiment("blocks", seed=5, names=RESPONSES[:1], specimens=("a", "b")),
    surface_experiment("random", seed=6, names=RESPONSES[:2], specimens=("a", "b", "c"),
                       treatment="random", missing=(0, 1)),
    screening_experiment(),
)  # fmt: skip
SURFACES = [result for result in RESULTS if result.surfaces is not None]


@pytest.fixture(scope="module")
def archive(tmp_path_factory):
    path = tmp_path_factory.mktemp("surfaces") / "surfaces.nc"
    write_archive(surfaces_to_dataset(RESULTS, origin=ABOUT), path)
    with open_archive(path) as dataset:
        yield dataset


def of_responses(thing, index, count, name=""):
    """One response of every array that has them on its first axis."""
    if is_dataclass(thing):
        return {
            item.name: of_responses(getattr(thing, item.name), index, count, item.name)
            for item in fields(thing)
        }
    if name in ("low", "high", "coded", "exponents", "engineering_matrix", "cell", "index"):
        return thing
    if isinstance(thing, np.ndarray):
        return thing[index]
    if name == "notes":  # a file has the sentence, not the numbers in it
        return [(one.code, one.severity, str(one)) for one in thing]
    return thing[index] if name in ("response_names", "transform") else thing


def assert_same(found, wanted, where=""):
    for name, one in wanted.items():
        other = found[name]
        if isinstance(one, dict):
            assert_same(other, one, f"{where}{name}.")
        elif isinstance(one, np.ndarray | np.generic):
            np.testing.assert_array_equal(other, one, err_msg=f"{where}{name}")
        else:
            assert other == one, f"{where}{name}"


def with_own_patterns(surfaces):
    """The same surfaces with a pattern each, as a file has them."""
    return replace(
        surfaces,
        covariance_factor=surfaces.covariance_factor[surfaces.pattern],
        is_used=surfaces.is_used[surfaces.pattern],
        pattern=np.arange(len(surfaces.pattern)),
    )


@pytest.mark.parametrize("result", SURFACES, ids=lambda result: result.name)
def test_every_field_of_every_surface_comes_back_to_the_last_bit(archive, result):
    names = surface_names(archive, result.name)
    assert set(names) == set(result.surfaces.response_names)
    found, wanted = surfaces_of(archive, result.name), with_own_patterns(result.surfaces)
    assert found.response_names == names
    for row, name in enumerate(names):
        place = wanted.response_names.index(name)
        of_file = of_responses(found, row, len(names))
        of_file["pattern"] = place
        assert_same(of_file, of_responses(wanted, place, len(names)))


@pytest.mark.parametrize("result", SURFACES, ids=lambda result: result.name)
def test_a_surface_is_evaluated_from_the_file_alone(archive, result):
    rng = np.random.default_rng(8)
    points = rng.uniform(LOW, HIGH, (20, 3))
    wanted = evaluate_surfaces(result.surfaces, points)
    for row, name in enumerate(result.surfaces.response_names):
        found = evaluate_surfaces(surfaces_of(archive, result.name, [name]), points)
        for field in (
            "value", "mean_value", "variance_factor", "confidence_interval",
            "prediction_interval", "simultaneous_interval", "above_leverage",
        ):  # fmt: skip
            np.testing.assert_allclose(
                getattr(found, field)[0], getattr(wanted, field)[row], rtol=1e-12, err_msg=field
            )


def test_the_covariance_in_the_file_gives_the_uncertainty_in_the_file(archive):
    for name in surface_names(archive, "half-inch"):
        factor, sigma, deviation = (
            archive[f"{name}_{what}"].values[0]
            for what in ("covariance_factor", "sigma", "coefficient_random_standard_uncertainty")
        )
        np.testing.assert_allclose(np.sqrt(np.diag(factor)) * sigma, deviation, rtol=1e-12)


def test_a_screening_has_no_surface(archive):
    assert surface_names(archive, "screening") == ()
    with pytest.raises(ArchiveError, match=r"'screening' has no such surface; found no surface"):
        surfaces_of(archive, "screening")


def test_a_surface_that_an_experiment_lacks_is_refused(archive):
    message = r"'short' has no such surface; found loss_factor; needed apparent_spring_constant"
    with pytest.raises(ArchiveError, match=message):
        surfaces_of(archive, "short", ["loss_factor"])


def test_an_experiment_that_is_not_there_is_refused(archive, archives):
    with pytest.raises(ArchiveError, match=r"no such experiment; found one-inch; needed half-inch"):
        surfaces_of(archive, "one-inch")
    with (
        open_archive(archives[0]) as test,
        pytest.raises(ArchiveError, match=r"needed an archive of experiments"),
    ):
        surface_names(test, "half-inch")


def test_a_response_that_cannot_be_fitted_comes_back_with_its_reason():
    result = SURFACES[0]
    response = np.array(result.runs.response)
    response[1, 2:] = np.nan
    response[2] = 5.0
    runs = replace(result.runs, response=response)
    surfaces = fit_surfaces(
        runs.level, response, factor_names=FACTORS, response_names=result.response_names,
        low=LOW, high=HIGH, run_names=runs.names,
    )  # fmt: skip
    assert surfaces.reason.tolist()[:3] == [0, 1, 4]
    about = replace(result, runs=runs, surfaces=surfaces, shared=None)
    found = surfaces_of(surfaces_to_dataset([about], origin=ABOUT), result.name)
    np.testing.assert_array_equal(found.reason, surfaces.reason)
    np.testing.assert_array_equal(found.is_used, surfaces.is_used[surfaces.pattern])
    np.testing.assert_array_equal(found.coefficient, surfaces.coefficient)
