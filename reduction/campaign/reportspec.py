"""``[report]`` of campaign.toml: what a laboratory states in the report to its client."""

from __future__ import annotations

import datetime
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StringConstraints

from reduction.archive.budgetplaces import parse_place
from reduction.campaign.faults import in_toml
from reduction.campaign.plan import TestPlan, product_of
from reduction.errors import SettingsError
from reduction.laboratory import DecisionRule, Instrument, Item, Limit, Paper, Party, ReportDetails
from reduction.units import parse_in_unit
from reduction.vocabulary import QUANTITIES, quantity

__all__ = ["ReportSection", "report_details"]

Text = Annotated[str, StringConstraints(max_length=4000, strip_whitespace=True)]


def _as_text(value: object) -> object:
    """A date of TOML as it is written there."""
    return value.isoformat() if isinstance(value, datetime.date) else value


Date = Annotated[Text, BeforeValidator(_as_text)]
"""A date of TOML, or text: ``2026-03-05``, ``"2 to 5 March 2026"``."""


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LaboratorySection(_Section):
    """``[report.laboratory]``."""

    name: Text = ""
    address: Text = ""
    contact: Text = ""
    location: Text = ""
    """Where the tests were made, where that is not the address."""
    accreditation: Text = ""


class ClientSection(_Section):
    """``[report.client]``."""

    name: Text = ""
    address: Text = ""
    contact: Text = ""
    order: Text = ""


class ItemSection(_Section):
    """``[report.items.SPECIMEN]``: what came in."""

    identification: Text = ""
    """What is written on it: a serial number, a tag."""
    description: Text = ""
    condition: Text = ""
    """On receipt."""
    received: Date = ""


class AuthorisedSection(_Section):
    """``[report.authorised]``."""

    by: Text = ""
    function: Text = ""
    on: Date = ""


class InstrumentSection(_Section):
    """``[[report.instruments]]``."""

    name: Text
    identification: Text = ""
    certificate: Text = ""
    traceable_to: Text = ""
    calibrated: Date = ""
    due: Date = ""


class LimitSection(_Section):
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


class ReportSection(_Section):
    """``[report]``: every key may be left out; the report then says that it is not stated."""

    number: Text = ""
    revision: int = Field(default=0, ge=0)
    amendment: Text = ""
    """What this revision changed, and which report it replaces."""
    issued: Date = ""
    received: Date = ""
    """When the items came in, where they came together."""
    tested: Date = ""
    method: Text = ""
    deviations: Text = ""
    """From the method: ``"none"`` where there were none."""
    sampling: Text = ""
    environment: Text = ""
    opinions: Text = ""
    """Opinions and interpretations, which the report marks as such."""
    decision_rule: DecisionRule | None = None
    """Required where a limit is given."""
    paper: Paper = "A4"
    laboratory: LaboratorySection = LaboratorySection()
    client: ClientSection = ClientSection()
    authorised: AuthorisedSection = AuthorisedSection()
    items: dict[str, ItemSection] = Field(default_factory=dict)
    instruments: tuple[InstrumentSection, ...] = ()
    limits: tuple[LimitSection, ...] = ()


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
    plain = section.model_dump(
        exclude={"laboratory", "client", "authorised", "items", "instruments", "limits"}
    )
    return ReportDetails(
        **plain,
        laboratory=Party(**section.laboratory.model_dump()),
        client=Party(**section.client.model_dump()),
        authorised_by=section.authorised.by,
        authorised_function=section.authorised.function,
        authorised_on=section.authorised.on,
        items=tuple(Item(name, **one.model_dump()) for name, one in section.items.items()),
        instruments=tuple(Instrument(**one.model_dump()) for one in section.instruments),
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
    return Limit(one.quantity, product[0], at, lower, upper, one.source)
