"""Experiments of a campaign: levels with their units, runs and slow pulls that exist."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NoReturn

from reduction.campaign.model import ExperimentSection
from reduction.campaign.plan import ExperimentPlan, TestPlan, product_of
from reduction.errors import SettingsError
from reduction.record import Specimen
from reduction.surface.levels import FactorLevels, LevelBasis
from reduction.units import Dimension, parse_quantity

NEED_PULL = ("dissipation_spring_constant", "relaxation_time", "dashpot_coefficient")
"""Responses that rest on the quasi-static spring constant."""

_DIMENSIONS: dict[str, Dimension] = {
    "frequency": "frequency",
    "mean_tension": "force",
    "tension_amplitude": "force",
    "mean_strain": "strain",
    "strain_amplitude": "strain",
    "temperature": "temperature",
    "duration": "number",
    "diameter": "length",
}
_SHARE = re.compile(r"^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*%\s*(RBS|MBS|MBL|of mean)\s*$")
_BASIS: dict[str, LevelBasis] = {
    "RBS": "rated_break_strength",
    "MBS": "rated_break_strength",
    "MBL": "rated_break_strength",
    "of mean": "mean_tension",
}
_DYNAMIC = ("cyclic", "fatigue", "snap")
_PULLS = ("quasi-static", "tensile")


def parse_factor(name: str, levels: tuple[str, str]) -> FactorLevels:
    """Levels of a factor from text with units.

    Parameters
    ----------
    name : str
        Of the factor; one that is not known takes plain numbers.
    levels : tuple of str
        Low and high: ``"0.1 Hz"``, ``"12 %RBS"``, ``"40 % of mean"``.

    Returns
    -------
    levels : FactorLevels
        In SI, or as a share with its basis.

    Raises
    ------
    SettingsError
        If a unit is missing or wrong, the two levels have different bases, or do not rise.

    Examples
    --------
    >>> parse_factor("mean_tension", ("12 %RBS", "30 %RBS"))
    FactorLevels(name='mean_tension', low=0.12, high=0.3, basis='rated_break_strength')
    """
    shares = [_SHARE.match(text) for text in levels]
    bases = {_BASIS[share[2]] if share else "absolute" for share in shares}
    if len(bases) > 1:
        raise SettingsError(
            f"the two levels of {name} are not given in one way",
            found=" and ".join(levels),
            needed="both in a unit, both in %RBS, or both in % of mean",
        )
    low, high = (
        float(share[1]) / 100 if share else parse_quantity(text, _DIMENSIONS.get(name, "number"))
        for share, text in zip(shares, levels, strict=True)
    )
    basis: LevelBasis = _BASIS[shares[0][2]] if shares[0] else "absolute"
    return FactorLevels(name, low, high, basis)


def plan_experiment(
    path: Path,
    name: str,
    section: ExperimentSection,
    *,
    tests: Mapping[str, TestPlan],
    specimens: Mapping[str, Specimen],
) -> ExperimentPlan:
    """An experiment with every name in it resolved.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml, for the messages.
    name : str
        Of the experiment.
    section : ExperimentSection
        As written.
    tests : mapping of str to TestPlan
        Of the campaign.
    specimens : mapping of str to Specimen
        Of the campaign.

    Returns
    -------
    plan : ExperimentPlan
        Runs and pulls named as their products are.

    Raises
    ------
    SettingsError
        If a run, a pull or a specimen is not in the campaign or of the wrong kind, the
        levels do not pair up with the factors or lie beyond -1 and 1, a response stands
        twice or only under ``transform``, or a share has no break strength.
    """

    def refuse(problem: str, *, found: str | None = None, needed: str | None = None) -> NoReturn:
        raise SettingsError(f"{path}: experiment '{name}': {problem}", found=found, needed=needed)

    try:
        factors = tuple(parse_factor(key, levels) for key, levels in section.factors.items())
    except SettingsError as error:
        raise SettingsError(f"{path}: experiment '{name}': {error}") from error
    _check_responses(section, refuse)
    runs: dict[str, tuple[float, ...]] = {}
    for run, coded in section.runs.items():
        product, kind = product_of(run, tests) or refuse(
            "a run is no test of the campaign", found=run,
            needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
        if kind not in _DYNAMIC:
            refuse(f"run '{run}' has no cycles", found=kind, needed="a cyclic test or step")
        is_short = len(coded) < len(factors)
        if is_short or (section.kind == "box-behnken" and len(coded) != len(factors)):
            refuse(
                f"run '{run}' has {len(coded)} coded levels", needed=f"{len(factors)}, one a factor"
            )
        # not (a <= 1) also catches NaN
        beyond = [level for level in coded if not abs(level) <= 1]
        if beyond:
            refuse(
                f"run '{run}' is planned beyond the levels of its factors",
                found=f"coded {beyond[0]:g}", needed="coded levels from -1 to 1",
            )  # fmt: skip
        runs[product] = coded
    if len({len(coded) for coded in runs.values()}) > 1:
        refuse("the runs differ in the number of coded levels")
    pulls: dict[str, str] = {}
    for specimen, pull in section.quasi_static.items():
        product, kind = product_of(pull, tests) or refuse(
            f"the slow pull of '{specimen}' is no test of the campaign", found=pull,
            needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
        if kind not in _PULLS:
            refuse(f"'{pull}' is no slow pull", found=kind, needed=" or ".join(_PULLS))
        if specimen not in tests[pull.partition("/")[0]].specimens:
            refuse(f"the slow pull '{pull}' does not pull '{specimen}'")
        pulls[specimen] = product
    if any(factor.basis == "rated_break_strength" for factor in factors):
        pulled = {one for run in section.runs for one in tests[run.partition("/")[0]].specimens}
        bare = sorted(one for one in pulled if specimens[one].rated_break_strength is None)
        if bare:
            refuse(
                "a level is a share of the break strength, which is not stated",
                found="no rated_break_strength of " + ", ".join(bare),
                needed='specimens.NAME.rated_break_strength = "6400 lbf"',
            )
    return ExperimentPlan(
        name=name,
        kind=section.kind,
        factors=factors,
        runs=runs,
        quasi_static=pulls,
        responses=section.responses,
        transform={key: value for key, value in section.transform.items() if value != "none"},
        specimens_as=section.specimens_as,
        term_reduction=section.term_reduction,
    )


def _check_responses(section: ExperimentSection, refuse: Callable[..., NoReturn]) -> None:
    """Each response once, and a transform for no other."""
    listed = ", ".join(section.responses)
    if len(set(section.responses)) < len(section.responses):
        refuse("a response stands twice", found=listed, needed="each response once")
    others = [name for name in section.transform if name not in section.responses]
    if others:
        refuse(
            "a transform is for a response that is not asked for", found=", ".join(others),
            needed=f"one of responses: {listed}",
        )  # fmt: skip


def agree_on_pulls(
    path: Path, experiments: Mapping[str, ExperimentPlan], tests: Mapping[str, TestPlan]
) -> None:
    """Refuse a run of two experiments that name two slow pulls for one specimen.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml, for the messages.
    experiments : mapping of str to ExperimentPlan
        Of the campaign.
    tests : mapping of str to TestPlan
        Of the campaign.

    Raises
    ------
    SettingsError
        If a run would have two quasi-static spring constants.  An experiment that names no
        pull is another answer too, where it asks for a response that rests on one.
    """
    first: dict[tuple[str, str], tuple[str, str]] = {}
    for name, plan in experiments.items():
        asks = not set(NEED_PULL).isdisjoint(plan.responses)
        for run in plan.runs:
            for specimen in tests[run.partition(".")[0]].specimens:
                pull = plan.quasi_static.get(specimen, "")
                if not pull and not asks:
                    continue
                other, before = first.setdefault((run, specimen), (name, pull))
                if before != pull:
                    raise SettingsError(
                        f"{path}: run '{run}' is in two experiments that do not name one slow "
                        f"pull of '{specimen}'",
                        found=f"{before or 'none'} in '{other}', {pull or 'none'} in '{name}'",
                        needed="the same quasi_static in both: a run has one K_0",
                    )
