"""``[report]`` of campaign.toml: what a laboratory states in the report to its client."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path

from pydantic import Field

from reduction.archive.budgetplaces import parse_place
from reduction.archive.laboratory import Limit, ReportDetails, Section, Statement, Text
from reduction.campaign.faults import in_toml
from reduction.campaign.plan import TestPlan, product_of
from reduction.errors import SettingsError
from reduction.units import parse_in_unit
from reduction.vocabulary import QUANTITIES, quantity


class LimitSection(Section):
    """``[[report.limits]]``: a number that is held against a limit."""

    quantity: Text
    """As `reduction budget` names it: ``tangent_modulus``, ``segment_modulus``, ..."""
    test: Text
    """A test, or ``test/step``."""
    at: dict[str, str | int | float] = Field(default_factory=dict)
    """``{ specimen = "new", branch = "ascending", strain = "125 %" }``."""
    lower: str | None = None
    upper: str | None = None
    source: Text = ""


class ReportSection(Statement[LimitSection]):
    """``[report]``: every key may be left out; the report then says that it is not stated."""


def report_details(
    path: Path,
    section: ReportSection | None,
    *,
    specimens: Collection[str],
    tests: Mapping[str, TestPlan],
) -> ReportDetails | None:
    """Return what the laboratory states, limits in SI.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml.
    section : ReportSection or None
        As written.
    specimens : collection of str
        Of the campaign.
    tests : mapping of str to TestPlan
        Of the campaign.

    Returns
    -------
    details : ReportDetails or None
        None where the campaign has no ``[report]``.

    Raises
    ------
    SettingsError
        If an item is no specimen, a limit has no ends, a wrong unit or no such test, or limits
        are given without a decision rule.
    """
    if section is None:
        return None
    unknown = sorted(set(section.items) - set(specimens))
    if unknown:
        raise in_toml(
            path, "report.items names what is no specimen of the campaign",
            found=", ".join(unknown), needed=f"one of {', '.join(specimens)}",
        )  # fmt: skip
    if section.limits and section.decision_rule is None:
        raise in_toml(
            path, "report.limits are given, but no rule by which conformity is decided",
            needed='report.decision_rule = "simple acceptance" or "guard band"',
        )  # fmt: skip
    return ReportDetails(
        **{name: value for name, value in section if name != "limits"},
        limits=tuple(
            _limit(path, f"report.limits.{number}", one, tests)
            for number, one in enumerate(section.limits)
        ),
    )


def _limit(path: Path, place: str, one: LimitSection, tests: Mapping[str, TestPlan]) -> Limit:
    if one.quantity not in QUANTITIES:
        raise in_toml(
            path, f"{place}.quantity is not known", found=repr(one.quantity),
            needed="a name such as tangent_modulus; `reduction budget PRODUCT.nc` lists them",
        )  # fmt: skip
    product = product_of(one.test, tests)
    if product is None:
        raise in_toml(
            path, f"{place}.test is no test of the campaign", found=repr(one.test),
            needed="one of " + ", ".join(tests) + "; of a test with steps TEST/STEP",
        )  # fmt: skip
    if one.lower is None and one.upper is None:
        raise in_toml(path, f"{place} has no limit", needed="lower, upper, or both")
    try:
        lower, upper = (
            None if text is None else parse_in_unit(text, quantity(one.quantity).unit)
            for text in (one.lower, one.upper)
        )
        at = {key: parse_place(key, str(value)) for key, value in one.at.items()}
    except SettingsError as error:
        raise in_toml(
            path, f"{place}: {error.problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    if lower is not None and upper is not None and not lower < upper:
        raise in_toml(
            path, f"{place}: the lower limit is not below the upper one",
            found=f"{one.lower} and {one.upper}",
        )  # fmt: skip
    return Limit(
        quantity=one.quantity, test=product[0], at=at, lower=lower, upper=upper, source=one.source
    )
