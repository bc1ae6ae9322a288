"""One campaign that is being explored: its logs, its text, and what a change would make of a test.

Everything is made by the functions of `reduction run`: a text that campaign.toml may hold is
loaded, the log is surveyed with it, and the test is reduced to the dataset that its archive
would be written from.  Nothing is written but campaign.toml, and that on request.
"""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import xarray as xr

from reduction.batch.basis import Basis
from reduction.batch.firstpass import FirstPass
from reduction.batch.progress import Progress, Silent
from reduction.batch.reduce import dataset_of
from reduction.batch.standing import standing_product
from reduction.batch.survey import Survey, as_reduction_error, survey_log
from reduction.batch.wanted import Wanted, find_wanted, wanted_of
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign
from reduction.errors import SettingsError
from reduction.explore.file import CampaignText

COMMAND = "reduction run campaign.toml"


@dataclass(frozen=True)
class Made:
    """What a text makes of one test.

    ``dataset`` is None where it cannot be reduced, and ``error`` says why. ``is_standing`` where
    its archive is of this text. ``also`` are other tests that a run would make anew with this text
    and not with the one on the disk.
    """

    survey: Survey
    dataset: xr.Dataset | None
    error: str
    seconds: float
    is_standing: bool
    also: tuple[str, ...]


class Session:
    """A campaign that is being explored; to be used by one thread at a time.

    Parameters
    ----------
    path : pathlib.Path
        The campaign.toml.
    processed : pathlib.Path
        Folder of its archives.
    progress : Progress, optional
        Told of each log of the first pass.

    Raises
    ------
    ReductionError
        If the campaign cannot be loaded.
    """

    def __init__(self, path: Path, processed: Path, *, progress: Progress | None = None) -> None:
        self.path = path
        self._processed = processed
        self.read_again(progress)

    def read_again(self, progress: Progress | None = None) -> None:
        """Take campaign.toml, and what is found in its logs, as they are now."""
        text = CampaignText.read(self.path)
        campaign = load_campaign(self.path, text=text.text)
        inputs = _inputs(text, campaign)
        stamps = tuple(map(_stamp, inputs))
        now = find_wanted(campaign, progress=progress or Silent())
        # all of it, or what was there before
        self.text, self.campaign, self.surveys = text, campaign, now.first.surveys
        self._inputs, self._stamps, self._settings = inputs, stamps, _settings(now)

    @property
    def is_changed_on_disk(self) -> bool:
        """Whether campaign.toml, or a file that it names, is another than the one that was read."""
        is_same = CampaignText.read(self.path).digest == self.text.digest
        return not is_same or tuple(map(_stamp, self._inputs)) != self._stamps

    def survey(self, test: str) -> Survey:
        """The first pass over a test; `SettingsError` where the campaign lacks it."""
        for one in self.surveys:
            if one.plan.id == test:
                return one
        raise SettingsError("the campaign has no such test", found=repr(test))

    def changed(self, test: str, changes: Mapping[str, str]) -> CampaignText:
        """What campaign.toml would say; `SettingsError` where a change cannot be written."""
        plan = self.survey(test).plan
        control = changes.get("control") or plan.control
        return self.text.changed(plan.log, changes, control=control)

    def made(self, test: str, text: CampaignText) -> Made:
        """Reduce a test as a text says.

        Parameters
        ----------
        test : str
            Id of its product.
        text : CampaignText
            From `changed`, or as on the disk.

        Returns
        -------
        made : Made
            Of a test that cannot be reduced with its error.

        Raises
        ------
        SettingsError
            If the text is not a campaign that could be run, or a file changed on the disk: what is
            shown side by side is of the same files.
        """
        begun = time.perf_counter()
        if self.is_changed_on_disk:
            raise SettingsError(
                "campaign.toml, or a file that it names, changed on the disk since it was read",
                needed="it read again",
            )
        campaign, now = self._surveyed(text, self.survey(test).plan.log)
        survey = next(one for one in now.first.surveys if one.plan.id == test)
        error = survey.error or now.errors.get(test)
        dataset, is_standing = None, False
        if error is None:
            try:
                basis = now.basis(survey)
                # what a changed text gives has no archive yet
                is_same = text.digest == self.text.digest
                is_standing = is_same and self._is_standing(survey, basis)
                dataset, _ = dataset_of(campaign, survey, basis, command=COMMAND)
            except Exception as failure:
                # one text of many that are tried, even where the failure is a defect here
                error = as_reduction_error(failure)
        settings = _settings(now)
        others = (one.plan.id for one in now.first.surveys if one.plan.id != test)
        also = tuple(one for one in others if settings.get(one) != self._settings.get(one))
        said = "" if error is None else campaign.in_words(str(error))
        seconds = time.perf_counter() - begun
        return Made(replace(survey, located=None), dataset, said, seconds, is_standing, also)

    def _surveyed(self, text: CampaignText, log: str) -> tuple[Campaign, Wanted]:
        """The campaign of a text, with one of its logs read again."""
        campaign = load_campaign(self.path, text=text.text)
        if list(campaign.tests) != list(self.campaign.tests):
            raise SettingsError("the tests of the campaign changed", needed="the same tests")
        own = survey_log(campaign, log)
        place = [one.plan.log for one in self.surveys].index(log)
        surveys = [one for one in self.surveys if one.plan.log != log]
        surveys[place:place] = own
        first = FirstPass(surveys, {log: own})
        return campaign, wanted_of(campaign, first, progress=Silent())

    def _is_standing(self, survey: Survey, basis: Basis) -> bool:
        path = self._processed / f"{survey.plan.id}.nc"
        found = standing_product(path, survey, basis.settings, remarks=basis.remarks)
        return found is not None

    def save(self, text: CampaignText) -> None:
        """Put a text in the place of campaign.toml, and go on from it.

        Raises
        ------
        SettingsError
            If the file changed on the disk meanwhile.
        ArchiveError
            If the disk refuses.
        """
        load_campaign(self.path, text=text.text)
        self.text.replace_with(text)
        self.read_again()


def _settings(now: Wanted) -> dict[str, str]:
    """Every setting in force, by test; tests that failed have none."""
    sound = (one for one in now.first.surveys if one.plan.id not in now.failed)
    return {one.plan.id: now.basis(one).settings for one in sound}


def _inputs(text: CampaignText, campaign: Campaign) -> tuple[Path, ...]:
    """Every file that a campaign may be read from: those that its text and its tests name."""
    own = {campaign.folder / name for plan in campaign.tests.values() for name, _ in plan.files}
    return tuple(sorted({*text.named, *own, *campaign.copies.values()}))


def _stamp(path: Path) -> tuple[int, ...]:
    """Whatever changes with a file; of one that is not there the reader says so."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):  # the latter of a name that no file can have
        return ()
    return found.st_size, found.st_mtime_ns, found.st_ino
