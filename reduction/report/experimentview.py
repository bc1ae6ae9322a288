"""One experiment as the page reads it: a row of the archive of experiments, cut to its length."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from reduction.archive.surface_read import surface_names, surfaces_of
from reduction.record import Floats
from reduction.report.rowview import RowView
from reduction.report.style import Shown, shown
from reduction.surface.product import ResponseSurfaces
from reduction.units import UnitSystem, combined_unit, display_unit
from reduction.vocabulary import QUANTITIES, RESPONSES

FORM_WORDS = {
    "del-vecchio": "Del Vecchio",
    "mean-load": "mean load",
    "quadratic": "quadratic surface",
}
"""Names of the forms of stiffness on the page."""
_STRAINS = ("mean_strain", "strain_amplitude")


@dataclass(frozen=True)
class ExperimentView(RowView):
    """One experiment on the page: a row of the archive of experiments."""

    ENDS_AT: ClassVar[Mapping[str, str]] = {
        "run": "run_name",
        "factor": "factor_name",
        "plan_column": "plan_column_name",
    }

    @property
    def name(self) -> str:
        """Name of the experiment."""
        return self.text("experiment")

    @property
    def is_screening(self) -> bool:
        """True where effects of many factors were asked for, not a surface."""
        return self.text("experiment_kind") == "plackett-burman"

    @property
    def factors(self) -> tuple[str, ...]:
        """Names of the factors."""
        return self.texts("factor_name")

    @cached_property
    def responses(self) -> tuple[str, ...]:
        """What was measured in the runs."""
        return tuple(
            name
            for name in RESPONSES
            if f"{name}_measured" in self.data
            and (
                np.isfinite(self.array(f"{name}_measured")).any()
                or self.text(f"{name}_refusal")
                or self.text(f"{name}_effect_refusal")
            )
        )

    @cached_property
    def surfaces(self) -> ResponseSurfaces | None:
        """Surfaces of the responses and, last, of the transformed ones; None for a screening."""
        if not surface_names(self.data, self.name):
            return None
        return surfaces_of(self.data, self.name)

    @cached_property
    def runs(self) -> tuple[str, ...]:
        """Names of the runs, with the specimen where there are several."""
        names, specimens = self.texts("run_name"), self.texts("run_specimen")
        many = len(set(specimens)) > 1
        return tuple(
            f"{run} {specimen}" if many else run
            for run, specimen in zip(names, specimens, strict=True)
        )

    @cached_property
    def factor_units(self) -> tuple[Shown, ...]:
        """How the level of each factor is shown."""
        pairs = zip(self.factors, self.texts("factor_unit"), strict=True)
        return tuple(_factor_unit(name, unit, self.units) for name, unit in pairs)

    def factor_label(self, place: int) -> str:
        """Words of a factor with its unit, for an axis or a column."""
        return self.factor_units[place].label(in_words(self.factors[place]))

    def levels(self, place: int) -> tuple[float, float, float]:
        """Low, middle and high level of a factor, as shown."""
        low, high = (self.array(f"factor_{end}")[place] for end in ("low", "high"))
        factor = self.factor_units[place].factor
        return float(low * factor), float((low + high) / 2 * factor), float(high * factor)

    def per_run(self, name: str) -> Floats:
        """Values of a variable, or NaN, one a run."""
        found = self.array(name)
        return found if found.shape == (len(self.runs),) else np.full(len(self.runs), np.nan)

    def texts(self, name: str) -> tuple[str, ...]:
        """Values of a text variable, one an entry of its dimension; as many "" where none."""
        if name not in self.data:
            return ("",) * self.sizes.get("run" if name.startswith("run_") else "", 0)
        variable = self.data[name]
        cut = tuple(slice(self.sizes.get(str(dim))) for dim in variable.dims[1:])
        return tuple(str(text) for text in np.ravel(variable.values[self.index][cut]))

    def array_of_texts(self, name: str) -> NDArray[np.str_]:
        """Values of a text variable in their shape; of no length where there is none."""
        if name not in self.data:
            return np.full((0, 0), "")
        return np.asarray(self.data.variables[name].values[self.index], dtype=np.str_)

    def own_rows(self, name: str) -> list[dict[str, str]]:
        """Rows of the notes or of the cautions that are of this experiment."""
        if name not in self.data:
            return []
        columns = [one for one in map(str, self.data.variables) if one.startswith(name)]
        values = {one: self.data.variables[one].values.astype(str) for one in columns}
        own = np.flatnonzero(values[f"{name}_experiment"] == self.name)
        return [{one: str(values[one][place]) for one in columns} for place in own]

    def coefficient_unit(self, name: str, exponents: tuple[int, ...]) -> Shown:
        """Unit of an engineering coefficient of a surface, and its factor from SI."""
        of_response = response_unit(name, self.units)
        scale = of_response.factor
        for one, power in zip(self.factor_units, exponents, strict=True):
            scale /= one.factor**power
        unit = combined_unit(of_response.unit, [one.unit for one in self.factor_units], exponents)
        return Shown(unit, scale)


def in_words(name: str) -> str:
    """Return the name of a quantity as a reader says it.

    Examples
    --------
    >>> in_words("log_relaxation_time"), in_words("mean_tension")
    ('logarithm of relaxation time', 'mean tension')
    """
    for prefix, words in (("log_", "logarithm of "), ("box_cox_", "Box-Cox transform of ")):
        if name.startswith(prefix):
            return words + name.removeprefix(prefix).replace("_", " ")
    return name.replace("_", " ")


def response_unit(name: str, system: UnitSystem) -> Shown:
    """Return how a response, or the scale of its transform, is shown.

    Examples
    --------
    >>> response_unit("dashpot_coefficient", "us").unit
    'lbf s'
    >>> response_unit("log_hysteresis_energy", "us")
    Shown(unit='1', factor=1.0)
    """
    if name not in RESPONSES:
        return Shown("1", 1.0)
    unit = QUANTITIES[name].unit
    if unit == "J m-1":
        return shown("energy", system)
    if unit == "N s":
        force = shown("tension", system)
        return Shown(f"{force.unit} s", force.factor)
    return Shown(*display_unit(unit, system))


def _factor_unit(name: str, unit: str, system: UnitSystem) -> Shown:
    if name in _STRAINS:
        return shown("strain", system)
    if name == "diameter":
        return shown("small length", system)
    return Shown(*display_unit(unit, system))
