"""Coefficients of the response surfaces of a campaign as one table, with their covariance."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import xarray as xr

from reduction.archive.open import reading
from reduction.archive.surfaces_dataset import surface_names
from reduction.lines.archive_source import CYCLE, lines_of_archive, looked_up_surface
from reduction.lines.export_tables import TableColumn, ValueTable
from reduction.quantities.names import quantity
from reduction.quantities.units import UnitSystem, display_unit
from reduction.record.errors import DataError
from reduction.record.measurement import Floats

_COVARIANCE = "_covariance_factor"
_COEFFICIENT = "_coefficient"


def surface_table(
    path: Path, *, specimen: str | None = None, units: UnitSystem = "si"
) -> ValueTable:
    r"""Every surface of an archive: coefficients, standard uncertainties, covariance.

    Shape (n_experiments * n_responses * n_terms,); a response without a fit has no row.

    Notes
    -----
    A response is :math:`\sum_i B_i X_i` with the term :math:`X_i` of the levels: coded, -1 at the
    lowest and 1 at the highest, or in engineering units.  The covariance is that of the coded
    coefficients of one response, from the scatter and from errors that the runs share,

    .. math:: C = \sigma^2 (X^T X)^{-1} + \sum_k c_k c_k^T
    """
    with reading(path) as archive:
        names = [str(one) for one in archive["experiment"].values]
        chosen = [place for place, name in enumerate(names) if specimen in (None, name)]
        responses = [
            str(name).removesuffix(_COVARIANCE)
            for name in archive.variables
            if str(name).endswith(_COVARIANCE)
        ]
        parts = [
            found
            for place in chosen
            for response in responses
            if (found := _rows(archive, place, response, units)) is not None
        ]
        title = f"{archive.attrs.get('title', path.parent.name)}: response surfaces"
        is_synthetic = archive.attrs.get("synthetic") == "yes"
        source = (
            f"{path.parent.name}/{path.name}, {archive.attrs.get('source', 'no source stated')}"
        )
    if not parts:
        raise DataError(
            f"{path} has no surface" + (f" of '{specimen}'" if specimen else ""),
            needed="one of " + ", ".join(names) if specimen else "an experiment with a fit",
        )
    n_terms = parts[0]["coefficient"].size
    columns = [
        TableColumn(name, "", _MEANING[name], np.concatenate([part[name] for part in parts]))
        for name in _MEANING
    ]
    covariance = np.concatenate([part["covariance"] for part in parts])
    columns += [
        TableColumn(f"covariance_B{place + 1}", "", f"with B{place + 1}, coded, in unit squared",
                    covariance[:, place])
        for place in range(n_terms)
    ]  # fmt: skip
    notes = (*_doubts_of_runs(path, specimen), *_ABOUT)
    return ValueTable(title, tuple(columns), (source,), notes, is_synthetic)


def _doubts_of_runs(path: Path, specimen: str | None) -> tuple[str, ...]:
    """Why runs of the experiments have the status `check`, where their archives exist."""
    lines = [one for one in lines_of_archive(path) if specimen in (None, one.name)]
    return tuple(f"DOUBTFUL: {text}" for line in lines for text in line.warnings)


_PRINTED = (
    ("apparent_spring_constant", "lb/in/in x 10^4", "N", 1e4),
    ("hysteresis_energy", "lb-in/in", "J m-1", 1.0),
    ("dissipation_spring_constant", "lb/in/in x 10^4", "N", 1e4),
    ("relaxation_time", "s", "s", 1.0),
)
"""Responses in the order of the report, with its printed unit and power of ten."""

_FACTORS = (
    "MEAN", "f^2", "T_m^2", "dT^2", "f", "T_m", "dT", "f, T_m", "f, dT", "T_m, dT",
)  # fmt: skip

_F_CRIT = 3.48

_FOOT = ("r^2", "F-STAT", "F-CRIT", "F (Hz)", "T_m (lbs)", "dT (lbs)")


def printed_table(path: Path, *, specimen: str | None = None) -> ValueTable:
    """Surfaces of an archive in the columns of Tables 3, 11, 14 and 17 of CG-D-39-80.

    One block of rows per response: the factors B1 to B10 in coded levels, three decimals, then r2,
    F, and the range of each level; one column per experiment.  Always in pounds.

    Notes
    -----
    F-STAT is the ratio that the report prints, with the sum of squares of ten terms (which counts
    the mean twice), and F-CRIT its 3.48 (CG-14 of docs/errata.md); those of the regression are in
    the archive.
    """
    with reading(path) as archive:
        names = [str(one) for one in archive["experiment"].values]
        chosen = [
            place
            for place, name in enumerate(names)
            if specimen in (None, name)
            and [str(one) for one in archive["factor_name"].values[place]] == list(CYCLE)
        ]
        if not chosen:
            raise DataError(
                f"{path} has no surface over frequency, mean tension and tension amplitude"
                + (f" of '{specimen}'" if specimen else ""),
                found=", ".join(names), needed="an experiment with the factors of the report",
            )  # fmt: skip
        parts = [one for one in _PRINTED if f"{one[0]}{_COEFFICIENT}" in archive]
        columns = {
            names[place]: [cell for one in parts for cell in _printed_cells(archive, place, *one)]
            for place in chosen
        }
        title = f"{archive.attrs.get('title', path.parent.name)}: polynomial equation coefficients"
        source = f"{path.parent.name}/{path.name}, in the form of CG-D-39-80, Tables 3, 11, 14, 17"
        is_synthetic = archive.attrs.get("synthetic") == "yes"
    n_rows = len(_FACTORS) + len(_FOOT)
    terms = [f"B{place + 1}" for place in range(len(_FACTORS))] + [""] * len(_FOOT)
    made = {
        "RESPONSE": np.repeat([f"{name} ({unit})" for name, unit, *_ in parts], n_rows),
        "FACTOR": np.tile([*_FACTORS, *_FOOT], len(parts)),
        "COEFFICIENT": np.tile(terms, len(parts)),
        **{name: np.array(cells) for name, cells in columns.items()},
    }
    about = ("F-STAT and F-CRIT are formed as the report forms them; coefficients are of levels "
             "coded -1 and 1")  # fmt: skip
    return ValueTable(
        title,
        tuple(TableColumn(name, "", "as the report has it", cells) for name, cells in made.items()),
        (source,), (*_doubts_of_runs(path, specimen), about), is_synthetic,
    )  # fmt: skip


def _printed_cells(
    archive: xr.Dataset, place: int, response: str, _: str, unit: str, scale: float
) -> list[str]:
    """One column of one response."""

    def of(name: str) -> float:
        return float(archive[f"{response}_{name}"].values[place])

    pounds = display_unit(unit, "us")[1]
    coefficient = archive[f"{response}{_COEFFICIENT}"].values[place]
    if not np.isfinite(coefficient).all():
        return [""] * (len(_FACTORS) + len(_FOOT))
    ranges = []
    for number, name in enumerate(CYCLE):
        ends = [float(archive[f"factor_{end}"].values[place, number]) for end in ("low", "high")]
        shown = str(archive["factor_unit"].values[place, number])
        if name != "frequency" and shown == "1":
            strength = archive["run_rated_break_strength"].values[place]
            ends = [end * float(np.nanmean(strength)) for end in ends]
        by = display_unit("N", "us")[1] if name != "frequency" else 1.0
        low, high = (f"{end * by:.4g}" for end in ends)
        ranges.append(f"±{low} - ±{high}" if name == "tension_amplitude" else f"{low} - {high}")
    return [
        *(_three(pounds * one / scale) for one in coefficient),
        _three(of("r2")), f"{of('printed_f'):.2f}", f"{_F_CRIT:.2f}", *ranges,
    ]  # fmt: skip


def _three(value: float) -> str:
    """Three decimals without a zero before the point, as in the report.

    Examples
    --------
    >>> [_three(value) for value in (3.451, -0.0312, 0.0001)]
    ['3.451', '-.031', '.000']
    """
    text = f"{abs(value):.3f}".removeprefix("0")
    return f"-{text}" if value < 0 and text != ".000" else text


_MEANING = {
    "experiment": "by its name in the campaign",
    "response": "quantity; with log_ before it the surface is of its natural logarithm, with "
    "log_frequency_times_ of that of the frequency times it",
    "looked_up": "whether the look-up answers from this surface of the response",
    "response_is": "what the response is, with its unit; the sum is that of coefficient times term",
    "term": "number of the term, as the reports count",
    "term_name": "product of levels that the coefficient multiplies",
    "unit": "of the coded coefficient",
    "coefficient": "of coded levels",
    "coefficient_standard_uncertainty": "of the coded coefficient (k = 1)",
    "degrees_of_freedom": "of the scatter",
    "unit_engineering": "of the coefficient of levels as they are",
    "coefficient_engineering": "of levels as they are",
    "coefficient_engineering_standard_uncertainty": "of the coefficient of levels (k = 1)",
    "levels": "lowest and highest level of each factor, coded -1 and 1",
}

_ABOUT = (
    "the look-up takes a response from the surface with looked_up = yes; response_is says what the"
    " sum of coefficient times term stands for",
    "covariance: of the coded coefficients of one response, scatter and shared errors together; the"
    " intervals of the look-up also hold what a quadratic misses between the tested levels",
)

_READ_AS = {
    "log_frequency_times_": "exp(sum) / frequency in Hz",
    "log_": "exp(sum)",
    "box_cox_": "(1 + {exponent:.6g} sum)^(1 / {exponent:.6g})",
    "": "sum",
}
"""Description of a response, by the scale of its surface."""


def _rows(
    archive: xr.Dataset, place: int, response: str, units: UnitSystem
) -> dict[str, np.ndarray] | None:
    """Columns of one surface."""

    def of(name: str) -> Floats:
        return np.asarray(archive[f"{response}{name}"].values[place], dtype=np.float64)

    coefficient = of(_COEFFICIENT)
    if not np.isfinite(coefficient).any():
        return None
    scale = next(one for one in _READ_AS if response.startswith(one))
    plain = response.removeprefix(scale)
    system: UnitSystem = "si" if scale else units
    experiment = str(archive["experiment"].values[place])
    unit, factor = _shown(archive[f"{response}{_COEFFICIENT}"].attrs.get("units", "1"), system)
    names = [str(one) for one in archive["factor_name"].values[place]]
    shown = [_shown(str(one), system) for one in archive["factor_unit"].values[place]]
    terms = [str(one) for one in archive["term_name"].values[place]]
    powers = np.array([[_power(term, name) for name in names] for term in terms])
    per_level = factor / np.prod(np.array([one[1] for one in shown]) ** powers, axis=1)
    contribution = np.nan_to_num(of(f"{_COEFFICIENT}_uncertainty_contribution"))
    covariance = of("_sigma") ** 2 * of(_COVARIANCE) + contribution.T @ contribution
    n_terms = len(terms)
    low, high = (archive[f"factor_{end}"].values[place] for end in ("low", "high"))
    levels = "; ".join(
        f"{name} {one[1] * a:.6g} to {one[1] * b:.6g} {one[0]}"
        for name, one, a, b in zip(names, shown, low, high, strict=True)
    )
    exponent = 0.0 if scale != "box_cox_" else float(of("_transform_exponent"))
    read_as = _READ_AS[scale].format(exponent=exponent)
    response_unit = unit if not scale else quantity(plain).unit
    is_looked_up = looked_up_surface(plain, surface_names(archive, experiment)) == response
    return {
        "experiment": np.full(n_terms, experiment),
        "response": np.full(n_terms, response),
        "looked_up": np.full(n_terms, "yes" if is_looked_up else "no"),
        "response_is": np.full(n_terms, f"{read_as}, in {response_unit}"),
        "term": np.array([f"B{number + 1}" for number in range(n_terms)]),
        "term_name": np.array(terms),
        "unit": np.full(n_terms, unit),
        "coefficient": factor * coefficient,
        "coefficient_standard_uncertainty": factor * of(f"{_COEFFICIENT}_standard_uncertainty"),
        "degrees_of_freedom": np.full(n_terms, of("_degrees_of_freedom")),
        "unit_engineering": np.array(
            [_over(unit, [one[0] for one in shown], row) for row in powers]
        ),
        "coefficient_engineering": per_level * of(f"{_COEFFICIENT}_engineering"),
        "coefficient_engineering_standard_uncertainty": (
            per_level * of(f"{_COEFFICIENT}_engineering_standard_uncertainty")
        ),
        "levels": np.full(n_terms, levels),
        "covariance": factor**2 * covariance,
    }


def _shown(unit: str, units: UnitSystem) -> tuple[str, float]:
    """Unit and factor; foot-pounds per foot are pounds."""
    shown, factor = display_unit(unit, units)
    return ("lbf" if shown == "ft lbf / ft" else shown), factor


def _power(term: str, name: str) -> int:
    """Exponent of a level in a term.

    Examples
    --------
    >>> _power("frequency^2", "frequency"), _power("frequency*mean", "mean"), _power("mean", "rate")
    (2, 1, 0)
    """
    return sum(
        int(one.partition("^")[2] or 1) for one in term.split("*") if one.partition("^")[0] == name
    )


def _over(unit: str, factors: list[str], powers: np.ndarray) -> str:
    """Unit of a coefficient over levels.

    Examples
    --------
    >>> _over("J m-1", ["Hz", "N"], np.array([1, 2]))
    'J m-1 Hz-1 N-2'
    >>> _over("N", ["N"], np.array([1]))
    '1'
    """
    power: dict[str, int] = {}
    for name, exponent in re.findall(r"([A-Za-z]+)(-?\d+)?", unit):
        power[name] = power.get(name, 0) + int(exponent or 1)
    for name, exponent in zip(factors, powers.tolist(), strict=True):
        power[name] = power.get(name, 0) - int(exponent)
    words = [name if of == 1 else f"{name}{of}" for name, of in power.items() if of and name != "1"]
    return " ".join(words) or "1"
