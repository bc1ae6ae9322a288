"""SPEC.toml of an experiment: what `reduction experiment` plans and `reduction surface` fits."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from reduction.campaign.cells import CODED
from reduction.campaign.experiments import parse_factor
from reduction.campaign.faults import in_toml
from reduction.campaign.toml import read_toml
from reduction.errors import SettingsError
from reduction.surface.designs import DesignKind
from reduction.surface.levels import FactorLevels
from reduction.surface.runsheet import RepeatPlacing
from reduction.surface.transform import Transform
from reduction.units import parse_quantity, scale_of_unit
from reduction.vocabulary import QUANTITIES, quantity

# stands in a header of the run sheet and in the name of a term
ColumnName = Annotated[
    str, StringConstraints(pattern=r"^[^\s\[\]*^,;#][^\[\]*^,;]{0,99}$", strip_whitespace=True)
]
_UNIT = re.compile(r"^\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*(.*?)\s*$")


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class ExperimentKeys(_Section):
    """``[experiment]``."""

    kind: DesignKind | None = None
    levels: Literal["engineering", "coded"] = "engineering"
    """What the columns of the factors hold in a table of runs, where no header says it."""
    rated_break_strength: str | None = None
    load_limit: str | None = None
    """Greatest tension of machine, cell or laboratory: a force or a share, ``"40 %RBS"``."""
    n_centre: int | None = Field(default=None, ge=0)
    n_runs: int | None = None
    repeats: RepeatPlacing = "together"
    sigma: str | None = None
    """Scatter of one run: ``"2 %"`` of the response, or in its unit."""
    specimens_as: Literal["blocks", "random"] = "blocks"


class ResponseKeys(_Section):
    """``[responses.NAME]``."""

    unit: str = ""
    transform: Transform = "none"


class SpecFile(_Section):
    """The whole of SPEC.toml."""

    experiment: ExperimentKeys = ExperimentKeys()
    factors: dict[ColumnName, tuple[str | float, str | float]] = Field(default_factory=dict)
    responses: dict[ColumnName, ResponseKeys] = Field(default_factory=dict)


@dataclass(frozen=True)
class FactorSpec:
    """A factor with the unit its levels are written in and the SI unit behind it.

    ``levels`` is None of a factor that a table of runs gives coded and nobody has declared.
    """

    name: str
    levels: FactorLevels | None = None
    unit: str = CODED
    si_unit: str = "1"

    def axis(self, strength: float | None) -> tuple[str, float, float]:
        """Unit, low and high level on the scale that a surface is fitted on.

        A share of a break strength that is known becomes a force.
        """
        if self.levels is None:
            return self.si_unit, -1.0, 1.0
        if self.levels.basis == "rated_break_strength" and strength is not None:
            return "N", strength * self.levels.low, strength * self.levels.high
        return self.si_unit, self.levels.low, self.levels.high


@dataclass(frozen=True)
class ResponseSpec:
    """A response as written: unit is empty where none is stated."""

    name: str
    unit: str = ""
    transform: Transform = "none"


@dataclass(frozen=True)
class ExperimentSpec:
    """An experiment in SI; factors and responses are empty where the table of runs names them.

    ``sigma`` is a share of the response where ``sigma_unit`` is 1 [1], else in that unit.
    """

    kind: DesignKind | None
    levels: Literal["engineering", "coded"]
    rated_break_strength: float | None
    load_limit: float | None
    peak_share_limit: float | None
    n_centre: int | None
    n_runs: int | None
    repeats: RepeatPlacing
    sigma: float | None
    sigma_unit: str
    specimens_as: Literal["blocks", "random"]
    factors: tuple[FactorSpec, ...]
    responses: tuple[ResponseSpec, ...]


def _written_unit(text: str) -> str:
    match = _UNIT.match(text)
    return match[1] if match else ""


def _factor(name: str, written: tuple[str | float, str | float]) -> FactorSpec:
    low, high = (str(level).strip() for level in written)
    units = {_written_unit(level) for level in (low, high)}
    if len(units) > 1:
        raise SettingsError(
            f"the two levels of {name} are not given in one way",
            found=f"{low} and {high}",
            needed="both in one unit",
        )
    (unit,) = units
    if "%" in unit and unit != "%":
        return FactorSpec(name, parse_factor(name, (low, high)), unit)
    if name in ("frequency", "mean_tension", "tension_amplitude"):
        return FactorSpec(name, parse_factor(name, (low, high)), unit, quantity(name).unit)
    # any other factor has whatever dimension its unit has
    si_unit, factor, offset = scale_of_unit(unit)
    numbers = [parse_quantity(level.removesuffix(unit), "number") for level in (low, high)]
    bottom, top = (factor * number + offset for number in numbers)
    return FactorSpec(name, FactorLevels(name, bottom, top), unit, si_unit)


def response_unit(name: str, unit: str) -> tuple[str, float, float]:
    """SI unit of a response, with factor and offset to it.

    Parameters
    ----------
    name : str
        Of the response; the unit of a quantity that the vocabulary has is spelt as there.
    unit : str
        As written; empty where none is stated.

    Returns
    -------
    si_unit : str
        Empty where no unit is stated: the numbers stay as they are.
    factor, offset : float
        ``factor * value + offset`` is in SI.

    Raises
    ------
    SettingsError
        If the unit is unknown, or not one of the quantity.

    Examples
    --------
    >>> response_unit("hysteresis_energy", "lbf")
    ('J m-1', 4.4482216152605, 0.0)
    """
    if not unit:
        return "", 1.0, 0.0
    si_unit, factor, offset = scale_of_unit(unit)
    if name not in QUANTITIES:
        return si_unit, factor, offset
    known = quantity(name).unit
    if scale_of_unit(known)[0] != si_unit:
        raise SettingsError(
            f"unit '{unit}' is not a unit of {name}", found=f"'{unit}'", needed=f"such as {known}"
        )
    return known, factor, offset


def _limit(text: str, strength: float | None) -> tuple[float | None, float | None]:
    """A load limit in newtons, or as a share of the break strength."""
    if re.search(r"%\s*(RBS|MBS|MBL)\s*$", text):
        return None, parse_quantity(text, "force", rated_break_strength=1.0)
    return parse_quantity(text, "force", rated_break_strength=strength), None


def _sigma(text: str) -> tuple[float, str]:
    unit = _written_unit(text)
    number = parse_quantity(text.strip().removesuffix(unit), "number")
    si_unit, factor, _ = scale_of_unit(unit)
    if not number > 0:
        raise SettingsError("sigma is not above zero", found=repr(text), needed='such as "2 %"')
    return factor * number, si_unit


def load_spec(path: Path) -> ExperimentSpec:
    """Read SPEC.toml.

    Parameters
    ----------
    path : pathlib.Path
        The file.

    Returns
    -------
    spec : ExperimentSpec
        In SI, or as shares with their basis.

    Raises
    ------
    SettingsError
        If a value is still ``?``, or a key, a value or a unit cannot be used.
    """
    file = read_toml(
        path,
        SpecFile,
        what="the experiment",
        needed="a SPEC.toml with [experiment], [factors] and [responses]",
        keys="docs/experiments.md lists every key",
    )
    keys = file.experiment
    place = "experiment"
    try:
        strength = None
        if keys.rated_break_strength is not None:
            place = "experiment.rated_break_strength"
            strength = parse_quantity(keys.rated_break_strength, "force")
            if not strength > 0:
                raise SettingsError("a break strength is above zero", found=f"{strength:g} N")
        place = "experiment.load_limit"
        limit, share = (
            (None, None) if keys.load_limit is None else _limit(keys.load_limit, strength)
        )
        place = "experiment.sigma"
        sigma, sigma_unit = (None, "1") if keys.sigma is None else _sigma(keys.sigma)
        factors = []
        for name, levels in file.factors.items():
            place = f"factors.{name}"
            factors.append(_factor(name, levels))
        for name, response in file.responses.items():
            place = f"responses.{name}"
            response_unit(name, response.unit)
    except SettingsError as error:
        raise in_toml(
            path, f"{place}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    twice = sorted(file.factors.keys() & file.responses.keys())
    if twice:
        raise in_toml(path, "a factor is a response too", found=", ".join(twice))
    return ExperimentSpec(
        kind=keys.kind,
        levels=keys.levels,
        rated_break_strength=strength,
        load_limit=limit,
        peak_share_limit=share,
        n_centre=keys.n_centre,
        n_runs=keys.n_runs,
        repeats=keys.repeats,
        sigma=sigma,
        sigma_unit=sigma_unit,
        specimens_as=keys.specimens_as,
        factors=tuple(factors),
        responses=tuple(
            ResponseSpec(name, response.unit, response.transform)
            for name, response in file.responses.items()
        ),
    )
