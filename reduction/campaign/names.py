"""Names that become file names: the same products on every disk."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from reduction.archive.products import OF_CAMPAIGN
from reduction.campaign.faults import in_toml
from reduction.campaign.files import DEVICE
from reduction.campaign.plan import TestPlan


def check_names(path: Path, campaign: str, tests: Mapping[str, TestPlan]) -> None:
    """Refuse names under which two products would be one file somewhere.

    Parameters
    ----------
    path : pathlib.Path
        campaign.toml, for messages.
    campaign : str
        Its id, the name of a folder.
    tests : mapping of str to TestPlan
        By id; what letters an id has is checked before.

    Raises
    ------
    SettingsError
        If a name is a device of Windows, a product of every campaign, or that of another test or
        step where small and capital letters count as equal.
    """
    for name in (campaign, *tests):
        if DEVICE.fullmatch(name):
            raise in_toml(
                path, "a name is that of a device on Windows", found=repr(name),
                needed="another name: it becomes one of a file or of a folder",
            )  # fmt: skip
    seen = dict.fromkeys(OF_CAMPAIGN, "")
    for name in tests:
        other = seen.setdefault(name.casefold(), name)
        if not other:
            raise in_toml(
                path, f"test '{name}' has the name of a product of the campaign",
                needed="another name than " + ", ".join(OF_CAMPAIGN),
            )  # fmt: skip
        if other != name:
            raise in_toml(
                path, "the names of two tests differ in capital letters only",
                found=f"'{other}' and '{name}'", needed="names that are two on every disk",
            )  # fmt: skip
    for name, test in tests.items():
        if len({step.product(name).casefold() for step in test.steps}) < len(test.steps):
            raise in_toml(
                path, f"two steps of test '{name}' have one name",
                needed="names that are two on every disk",
                hint="Blanks and hyphens, small and capital letters count as equal.",
            )  # fmt: skip
