"""Comparisons of a campaign: a test that has a curve, and a hose that is predicted."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path

from reduction.campaign.faults import in_toml
from reduction.campaign.hosemodel import ComparisonSection
from reduction.campaign.plan import ComparisonPlan, TestPlan, product_of
from reduction.record import Specimen

_HAVE_CURVE = ("cyclic", "fatigue", "quasi-static", "tensile")


def plan_comparison(
    path: Path,
    name: str,
    section: ComparisonSection,
    *,
    tests: Mapping[str, TestPlan],
    hoses: Collection[str],
    specimens: Mapping[str, Specimen],
) -> ComparisonPlan:
    """A comparison with every name in it resolved.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml, for the messages.
    name : str
        Of the comparison.
    section : ComparisonSection
        As written.
    tests : mapping of str to TestPlan
        Of the campaign.
    hoses : collection of str
        Names of the hoses of the campaign.
    specimens : mapping of str to Specimen
        Of the campaign.

    Returns
    -------
    plan : ComparisonPlan
        Its test named as the product is.

    Raises
    ------
    SettingsError
        If the test, the specimen or the hose is not in the campaign, or the test has no curve
        of tension against strain.
    """
    place = f"comparison '{name}'"
    found = product_of(section.measured, tests)
    if found is None:
        raise in_toml(
            path, f"{place}: what was measured is no test of the campaign",
            found=section.measured, needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
    product, kind = found
    if kind not in _HAVE_CURVE:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no curve of tension against strain",
            found=kind, needed="one of " + ", ".join(_HAVE_CURVE),
        )  # fmt: skip
    if section.predicted not in hoses:
        raise in_toml(
            path, f"{place}: what is predicted is no hose of the campaign",
            found=section.predicted, needed="one of [hoses]: " + (", ".join(hoses) or "none"),
        )  # fmt: skip
    pulled = tests[section.measured.partition("/")[0]].specimens
    if section.specimen is None and len(pulled) > 1:
        raise in_toml(
            path, f"{place}: '{section.measured}' has several specimens",
            needed="specimen = one of " + ", ".join(pulled),
        )  # fmt: skip
    specimen = section.specimen or pulled[0]
    if specimen not in pulled:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no such specimen", found=specimen,
            needed="one of " + ", ".join(pulled),
        )  # fmt: skip
    if specimens[specimen].kind != "stretch hose":
        raise in_toml(
            path, f"{place}: '{specimen}' is no stretch hose", found=specimens[specimen].kind,
            needed='kind = "stretch hose" of what is held against a hose',
        )  # fmt: skip
    if len(set(section.calibrate)) < len(section.calibrate):
        raise in_toml(
            path, f"{place}: a number is to be calibrated twice",
            found=", ".join(section.calibrate),
        )  # fmt: skip
    return ComparisonPlan(
        name=name,
        measured=product,
        specimen=specimen,
        predicted=section.predicted,
        loading=section.loading,
        calibrate=section.calibrate,
    )
