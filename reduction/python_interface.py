"""Functions for scripts: run a campaign, look up, export, predict a hose, fit a surface.

Archives and campaigns are opened by `reduction.archive`; both are used as ``reduction.<name>``.
"""

from __future__ import annotations

import tempfile
import time
import warnings as python_warnings
from collections.abc import Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import tomlkit
import xarray as xr

from reduction.archive.campaign_tree import open_campaign
from reduction.batch.prediction_product import hoses_dataset
from reduction.batch.run_campaign import run_campaign
from reduction.batch.workers import local_workers
from reduction.campaign.experiment_plans import load_spec, read_runs
from reduction.campaign.hose_spec import load_hose
from reduction.campaign.load import load_campaign
from reduction.cli.experiments import fit_series, notes_of_fit
from reduction.cli.export import ExportedFiles, ExportRequest, write_export
from reduction.cli.lookup import (
    LookupRequest,
    line_of_request,
    lines_to_rank,
    lines_with,
    parsed_search,
)
from reduction.lines import line_lookup
from reduction.lines.line_lookup import Branch
from reduction.lines.line_rank import rank_lines
from reduction.lines.lookup_product import LEVEL_DIMENSIONS, DesignValues, LineSource
from reduction.lines.population import PopulationValues, population_values, specimens_of_kind
from reduction.prediction.hose_prediction import predict_from_plan
from reduction.quantities.names import name_of_quantity
from reduction.quantities.units import UnitSystem, parse_quantity
from reduction.readers.raw_log import hash_source
from reduction.record.errors import SettingsError
from reduction.uncertainty.surface_errors import surfaces_between_runs

_INTERVALS = {
    "": "95 % interval of one more run",
    "surface_": "95 % interval of the surface, or of the curve of one test",
    "line_": "95 % interval of another specimen of the kind",
}

_SHARES = {
    "peak_share": "greatest tension over the rated break strength",
    "minimum_share": "least tension over the rated break strength",
}

_FLAGS = {
    "is_inside": "whether it lies within the tested range",
    "is_above_rule": "whether the peak is above the rule of the source",
}


def look_up(
    source: str | Path,
    quantity: str,
    *,
    line: str | None = None,
    branch: Branch | None = None,
    extrapolate: Literal["refuse", "flag"] = "refuse",
    population: str | float | None = None,
    rank: bool = False,
    material: str | None = None,
    construction: str | None = None,
    condition: str | None = None,
    diameter: Any = None,
    tolerance: str | float | None = None,
    medium: str | None = None,
    temperature: str | None = None,
    **levels: Any,
) -> xr.Dataset:
    """Look up design values of a published line or of your own campaign.

    Parameters
    ----------
    source : str or pathlib.Path
        A published line by its name, ``"published"`` for all, an archive, or
        ``processed/<campaign>``.
    quantity : str
        Name, or symbol such as ``"K_ap"``.
    line : str, optional
        Line, where the source has several, such as ``"T-1 new"``.
    branch : {"ascending", "descending"}, optional
        Branch, for a quantity that differs by branch.
    extrapolate : {"refuse", "flag"}
        Action for points outside the tested range.
    population : str or float, optional
        Combine all specimens of one kind, with tolerance limits for this share of the kind, such
        as ``"95 %"``.
    rank : bool
        Order all lines by the quantity at one load.
    material, construction, condition : str, optional
        Only lines with these, such as ``"nylon"``, ``"double braid"``, ``"new"``.
    diameter : str, float or pint.Quantity, optional
        Only lines with this diameter. [m]
    tolerance : str or float, optional
        Relative tolerance of the diameter. [1]
    medium, temperature : str, optional
        Only tests under these conditions, such as ``"wet"``, ``"5 degC"``.
    **levels : str, float, array_like or xarray.DataArray
        ``frequency``, ``mean_tension``, ``tension_amplitude``, ``tension``, ``strain``, or for
        surfaces over strain ``mean_strain`` and ``strain_amplitude``: a text
        with a unit (``"20 %RBS"``), numbers in SI, or any object with ``to_base_units`` such as a
        pint quantity. Arrays are broadcast together, ``DataArray`` by the names of their
        dimensions.

    Returns
    -------
    values : xarray.Dataset
        The quantity with its 95 % intervals (``_low`` and ``_high``), flags, and in its attributes
        source, rule, warnings and errata. For a population also each specimen, their standard
        deviation and the limits; for a ranking one row per line, from the least to the greatest,
        with the lines that it ties with.

    Raises
    ------
    ReductionError
        If there is no such line, quantity or level, or a point lies outside the tested range.

    Examples
    --------
    Table 15 of CG-D-39-80 at the centre of the design, to the printed digits.

    >>> found = look_up("nylon-double-braid-0.5in-new", "K_ap", frequency="0.3 Hz",
    ...     mean_tension="21 %RBS", tension_amplitude="8.5 %RBS")
    >>> bool(found.is_inside), bool(found.apparent_spring_constant_low
    ...     < found.apparent_spring_constant < found.apparent_spring_constant_high)
    (True, True)
    """
    words = {"material": material, "construction": construction, "condition": condition}
    size = f"{diameter!r} m" if isinstance(diameter, float | int) else _plain(diameter)
    conditions = {"medium": medium, "temperature": temperature}
    wanted = LookupRequest(
        quantity=name_of_quantity(quantity), levels={}, name=line, branch=branch,
        extrapolate=extrapolate,
        search=parsed_search(words, size, None if tolerance is None else str(tolerance)),
        conditions={key: text for key, text in conditions.items() if text is not None},
    )  # fmt: skip
    if rank and population is not None:
        raise SettingsError(
            "only one option that combines lines is allowed", found="population and rank",
            needed="one of them",
        )  # fmt: skip
    if rank:
        return _ranking(lines_to_rank(str(source), wanted), wanted, levels)
    if population is not None:
        lines = specimens_of_kind(lines_with(str(source), wanted), wanted.quantity, line)
    else:
        lines = [line_of_request(str(source), wanted)]
    every, at = [], []
    for one in lines:
        axes = xr.broadcast(*(_level(key, value, one) for key, value in levels.items()))
        at.append({key: axis.values for key, axis in zip(levels, axes, strict=True)})
        every.append(
            line_lookup.look_up(
                one, wanted.quantity, branch=branch, extrapolate=extrapolate, **at[-1]
            )
        )
    like = axes[0] if axes else xr.DataArray(0.0)
    if population is None:
        return _dataset(every[0], lines[0], at[0], like)
    found = population_values(lines, every, parse_quantity(str(population), "number"))
    kind = replace(lines[0], name=f"{len(lines)} specimens")
    return _with_limits(_dataset(found.values, kind, at[0], like), found, like.dims)


def _with_limits(
    mean: xr.Dataset, found: PopulationValues, dims: tuple[Hashable, ...]
) -> xr.Dataset:
    """The mean of the specimens of a kind, with their scatter and the tolerance limits."""
    name, unit = found.values.quantity, {"units": found.values.unit}
    share = f"with 95 % confidence {100 * found.share:g} % of the kind"
    kept = {
        f"{name}_kind_low": (found.values.kind_low, "95 % interval of the mean of the kind"),
        f"{name}_kind_high": (found.values.kind_high, "95 % interval of the mean of the kind"),
        "standard_deviation": (found.standard_deviation, "between the specimens"),
        "lower_limit": (found.lower, f"{share} are above"),
        "upper_limit": (found.upper, f"{share} are below"),
        "two_sided_low": (found.both_low, f"{share} are between"),
        "two_sided_high": (found.both_high, f"{share} are between"),
    }
    limits: dict[str, Any] = {
        key: (dims, values, unit | {"long_name": words}) for key, (values, words) in kept.items()
    }
    limits["of_specimens"] = (("specimen", *dims), found.of_specimens, unit)
    about = {
        "share": found.share, "confidence": found.confidence,
        "one_sided_factor": found.one_sided_factor, "two_sided_factor": found.two_sided_factor,
    }  # fmt: skip
    return mean.assign(limits).assign_coords(specimen=list(found.specimens)).assign_attrs(about)


def _ranking(
    lines: Sequence[LineSource], wanted: LookupRequest, levels: Mapping[str, Any]
) -> xr.Dataset:
    """Lines from the least value of a quantity to the greatest, at one load."""
    points = [
        {key: _level(key, value, one).values for key, value in levels.items()} for one in lines
    ]
    found = rank_lines(
        lines, wanted.quantity, points, branch=wanted.branch, extrapolate=wanted.extrapolate
    )
    at = [points[lines.index(one.line)] for one in found.ranked]
    every = [
        _dataset(one.values, one.line, given, xr.DataArray(0.0)).assign(
            diameter=one.line.diameter,
            ties=", ".join(one.ties),
            line_ties="not known" if one.kind_ties is None else ", ".join(one.kind_ties),
        )
        for one, given in zip(found.ranked, at, strict=True)
    ]
    names = xr.DataArray([one.line.name for one in found.ranked], dims="line", name="line")
    ranked = xr.concat([one.reset_coords() for one in every], names, combine_attrs="drop")
    return ranked.assign_attrs(
        left_out="\n".join(f"{name}: {why}" for name, why in found.left_out),
        errata="\n".join(f"{one.id}: {one.corrected}" for one in found.errata),
    )


def _level(name: str, value: Any, line: LineSource) -> xr.DataArray:
    """A level in SI, with dimensions."""
    if name not in LEVEL_DIMENSIONS:
        raise SettingsError(
            f"{name} is not a level of a line", needed=f"one of {', '.join(LEVEL_DIMENSIONS)}"
        )
    if isinstance(value, xr.DataArray):
        is_axis = value.dims == (name,) and name not in value.coords
        return value.assign_coords({name: value.values}) if is_axis else value
    if isinstance(value, str):
        strength = line.rated_break_strength
        known = strength if np.isfinite(strength) else None
        value = parse_quantity(value, LEVEL_DIMENSIONS[name], rated_break_strength=known)
    elif _has_unit(value):
        text = f"1 {value.units}"
        value = np.asarray(value.magnitude) * parse_quantity(text, LEVEL_DIMENSIONS[name])
    numbers = np.asarray(value)
    if numbers.ndim > 1:
        raise SettingsError(
            f"{name} has several dimensions without names", found=f"shape {numbers.shape}",
            needed="a number, one row of numbers, or an xarray.DataArray",
        )  # fmt: skip
    return xr.DataArray(numbers, dims=("point",)[: numbers.ndim])


def _has_unit(value: Any) -> bool:
    """Whether it is a quantity of pint or a similar package."""
    return hasattr(value, "to_base_units")


def _plain(value: Any) -> Any:
    """A value as in a settings file: quantities become text with their unit."""
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if _has_unit(value):
        numbers = np.asarray(value.magnitude).tolist()
        unit = str(value.units)
        if isinstance(numbers, list):
            return [f"{one!r} {unit}" for one in numbers]
        return f"{numbers!r} {unit}"
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [_plain(one) for one in value] if isinstance(value, list | tuple) else value


def _table_of(runs: Mapping[str, Any] | pd.DataFrame | xr.Dataset) -> pd.DataFrame:
    """Columns as a table of runs, with their units in the headers."""
    if isinstance(runs, pd.DataFrame):
        return runs
    columns: dict[str, Any] = {}
    for name, column in runs.items():
        unit = column.attrs.get("units", "") if isinstance(column, xr.DataArray) else ""
        if _has_unit(column):
            unit, column = column.units, column.magnitude
        columns[f"{name} [{unit}]" if unit else str(name)] = np.asarray(column)
    return pd.DataFrame(columns)


@contextmanager
def _file_of(given: Any, name: str) -> Iterator[Path]:
    """The given file, or a temporary one with the given content."""
    if isinstance(given, str | Path):
        yield Path(given)
        return
    with tempfile.TemporaryDirectory(prefix="reduction-") as folder:
        path = Path(folder, name)
        is_table = path.suffix == ".csv"
        text = _table_of(given).to_csv(index=False) if is_table else tomlkit.dumps(_plain(given))
        path.write_text(text, encoding="utf-8", newline="")
        yield path


def _dataset(
    found: DesignValues, line: LineSource, given: Mapping[str, Any], like: xr.DataArray
) -> xr.Dataset:
    name, dims = found.quantity, like.dims
    kept: dict[str, Any] = {name: (dims, found.value, {"units": found.unit})}
    for prefix, words in _INTERVALS.items():
        for end in ("low", "high"):
            values = getattr(found, prefix + end)
            about = {"units": found.unit, "long_name": words}
            kept[f"{name}_{prefix}{end}"] = (dims, values, about)
    for one, words in {**_SHARES, **_FLAGS}.items():
        kept[one] = (dims, getattr(found, one), {"long_name": words})
    levels = {key: (dims, values) for key, values in given.items() if key not in like.coords}
    about = {
        "line": line.name, "source": found.source, "rule": found.rule,
        "warnings": "\n".join(found.warnings), "errata": "\n".join(found.errata),
        "notes": "\n".join(found.notes),
    }  # fmt: skip
    return xr.Dataset(kept, {**like.coords, **levels}, about)


def run(
    campaign: str | Path,
    *,
    processed: str | Path = "processed",
    reports: str | Path = "reports",
    tests: Sequence[str] = (),
    force: bool = False,
    jobs: int = 1,
    units: UnitSystem = "si",
) -> xr.DataTree | xr.Dataset:
    """Reduce a campaign, as ``reduction run`` does, and open the result.

    Parameters
    ----------
    campaign : str or pathlib.Path
        The campaign.toml.
    processed, reports : str or pathlib.Path
        Folders for the products and for the report.
    tests : sequence of str, optional
        Only these tests.
    force : bool
        Whether to repeat tests that did not change.
    jobs : int
        Number of parallel tests; above one, call it below ``if __name__ == "__main__":``.
    units : {"si", "us"}
        Units of the report; files are always SI.

    Returns
    -------
    campaign : xarray.DataTree
        As from `reduction.open_campaign`.

    Raises
    ------
    ReductionError
        If the campaign cannot be read, or every test of it failed.

    Warns
    -----
    UserWarning
        For each test that failed; the others are reduced nevertheless.
    """
    loaded = load_campaign(Path(campaign))
    with local_workers(jobs) if jobs > 1 else nullcontext() as workers:
        result = run_campaign(
            loaded, processed=Path(processed), reports=Path(reports), clock=time.perf_counter,
            tests=tuple(tests), force=force, command="reduction run campaign.toml", units=units,
            workers=workers,
        )  # fmt: skip
    for one in result.tests:
        if one.exit_status:
            python_warnings.warn(f"{one.test}: {one.message}", stacklevel=2)
    return open_campaign(result.processed)


def export(
    source: str | Path | Sequence[str | Path], to: str, out: str | Path, **options: Any
) -> ExportedFiles:
    """Write a curve for a mooring code or as a table, as ``reduction export`` does.

    Parameters
    ----------
    source : str, pathlib.Path, or a sequence of them
        A published line by its name, an archive, ``processed/<campaign>``, or several tests.
    to : str
        Format, such as ``"moordyn"`` or ``"csv"``.
    out : str or pathlib.Path
        Output file.
    **options : str, bool or pint.Quantity
        Options of the command, such as ``form="static-dynamic"``, ``frequency="0.3 Hz"`` or
        ``diameter="26 mm"``; ``units="us"`` for a table.

    Returns
    -------
    done : ExportedFiles
        ``paths`` of the written files, ``notes`` on untested content (also in the file headers),
        and with ``verify=True`` the ``checks`` by the program. ``plot()`` draws the curve.

    Raises
    ------
    ReductionError
        If the source cannot be written in this format.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = export("nylon-double-braid-0.5in-new", "csv", Path(folder, "rope.csv"))
    ...     [file.name for file in done.paths if file.is_file()]
    ['rope.csv']
    """
    known = {one.name for one in fields(ExportRequest)} - {"sources", "to", "out"}
    if unknown := sorted(set(options) - known):
        raise SettingsError(
            f"export has no option {unknown[0]}", needed=f"one of {', '.join(sorted(known))}"
        )
    sources = (source,) if isinstance(source, str | Path) else source
    stated = {name: _plain(option) for name, option in options.items()}
    request = ExportRequest(tuple(map(str, sources)), to, Path(out), **stated)
    return write_export(request)


def predict_hose(spec: str | Path | Mapping[str, Any]) -> xr.Dataset:
    """Predict a stretch hose, as ``reduction predict hose`` does.

    Parameters
    ----------
    spec : str, pathlib.Path or mapping
        The SPEC.toml of the hose, or its content: ``{"hose": {"wrap_angle": "64 deg", ...},
        "cord": {"strain": [...], "load": [...]}}``, with units in text or pint quantities.

    Returns
    -------
    hose : xarray.Dataset
        Tension, fill pressure and angle of the cords against strain, and the events, in the form
        of ``predictions.nc``.

    Raises
    ------
    ReductionError
        If such a hose cannot be built.
    """
    with _file_of(spec, "hose.toml") as path:
        plan, _ = load_hose(path)
        return hoses_dataset(
            [predict_from_plan(plan)],
            campaign_id=plan.name,
            attributes={"title": f"Prediction of hose {plan.name}"},
            source=hash_source(path, path.name),
            command=f"reduction predict hose {path.name}",
        )


def fit_surface(
    runs: str | Path | Mapping[str, Any] | pd.DataFrame | xr.Dataset,
    spec: str | Path | Mapping[str, Any] | None = None,
) -> xr.Dataset:
    r"""Fit quadratic response surfaces to a table of runs, as ``reduction surface`` does.

    Parameters
    ----------
    runs : str, pathlib.Path, mapping, pandas.DataFrame or xarray.Dataset
        A CSV of runs (levels of the factors and responses, one row per run), or its columns by
        name. Units are given in the names, ``"stiffness [N]"``, or by the columns (pint quantities,
        the attribute ``units``).
    spec : str, pathlib.Path or mapping, optional
        The SPEC.toml with low and high levels, or its content.

    Returns
    -------
    surfaces : xarray.Dataset
        Over ``response`` and ``term``: ``coefficient`` of coded levels, -1 to 1, with its
        ``covariance``, ``coefficient_engineering`` for levels in units, standard uncertainties,
        ``r2``, ``sigma``, and tests for lack of fit.  ``response_unit`` has the unit of a response.

    Raises
    ------
    ReductionError
        If the runs do not determine the ten terms, or their levels are not those of the plan.

    Warns
    -----
    UserWarning
        For each note that could affect the surface.

    Notes
    -----
    The covariance is that of the scatter, :math:`\sigma^2 (X^T X)^{-1}`: a table of runs does not
    show errors that its runs share, and an interval from the covariance leaves out the lack of fit
    of a quadratic between the levels.  Half way between them, over ``point``, the dataset has
    the values with their 95 % intervals, scatter and ``lack_of_fit_standard_uncertainty``.
    """
    loaded = None
    if spec is not None:
        with _file_of(spec, "spec.toml") as path:
            loaded = load_spec(path)
    with _file_of(runs, "runs.csv") as path:
        series = read_runs(path, loaded)
        found = fit_series(series, loaded, path)
    for text in notes_of_fit(series, found):
        python_warnings.warn(text, stacklevel=2)
    between = surfaces_between_runs(found)
    at_points = ("response", "point")
    variance = found.sigma[:, np.newaxis, np.newaxis] ** 2
    by_term, by_response = ("response", "term"), ("response",)
    return xr.Dataset(
        {
            "coefficient": (by_term, found.coefficient),
            "coefficient_standard_uncertainty": (by_term, found.coefficient_standard_uncertainty),
            "covariance": (
                ("response", "term", "other_term"),
                variance * found.covariance_factor[found.pattern],
            ),
            "coefficient_engineering": (by_term, found.coefficient_engineering),
            "coefficient_engineering_standard_uncertainty": (
                by_term,
                found.coefficient_engineering_standard_uncertainty,
            ),
            "p_value": (by_term, found.p_value),
            "r2": (by_response, found.r2),
            "sigma": (by_response, found.sigma),
            "degrees_of_freedom": (by_response, found.degrees_of_freedom),
            "lack_of_fit_f": (by_response, found.lack_of_fit.f),
            "lack_of_fit_p_value": (by_response, found.lack_of_fit.p_value),
            "low": (("factor",), found.low),
            "high": (("factor",), found.high),
            "point_coded": (("point", "factor"), between.coded),
            "point_value": (at_points, between.value),
            "point_low": (at_points, between.low),
            "point_high": (at_points, between.high),
            "lack_of_fit_standard_uncertainty": (at_points, between.discrepancy),
        },
        {
            "response": list(found.response_names),
            "response_unit": (by_response, list(series.response_units)),
            "transform": (by_response, list(found.transform)),
            "term": list(found.term_names),
            "other_term": list(found.term_names),
            "factor": list(found.factor_names),
            "factor_unit": (("factor",), list(series.factor_units)),
        },
        {"title": f"Response surfaces of {path.name}"},
    )
