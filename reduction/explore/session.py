"""One campaign that is being explored: its logs, its text, and what a change would make of a test.

Everything is made by the functions of `reduction run`: a text that campaign.toml may hold is
loaded, the log is surveyed with it, and the test is reduced to the dataset that its archive
would be written from.  Nothing is written but campaign.toml, and that on request.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import xarray as xr

from reduction.batch.basis import Basis, basis_of
from reduction.batch.executor import Serial
from reduction.batch.firstpass import FirstPass, survey_campaign
from reduction.batch.history import past_of
from reduction.batch.models import fit_strain_models
from reduction.batch.progress import Progress, Silent
from reduction.batch.pulls import fit_pulls
from reduction.batch.reduce import dataset_of
from reduction.batch.standing import standing_product
from reduction.batch.survey import Survey, as_reduction_error, survey_log
from reduction.campaign.load import load_campaign
from reduction.campaign.plan import Campaign
from reduction.errors import ReductionError, SettingsError
from reduction.explore.file import CampaignText
from reduction.explore.memory import Memory
from reduction.explore.records import KeptRecords, Stamp, stamp_of

__all__ = ["Made", "Session"]

COMMAND = "reduction run campaign.toml"
_MOST_KEPT = 6


@dataclass(frozen=True)
class Made:
    """What a text makes of one test.

    ``dataset`` is None where it cannot be reduced, and ``error`` says why. ``also`` are other
    tests that a run would make anew with this text and not with the one on the disk.
    """

    survey: Survey
    dataset: xr.Dataset | None
    error: str
    seconds: float
    is_standing: bool = False
    also: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Surveyed:
    """All tests of a campaign as a text has them, the records of one log among them."""

    campaign: Campaign
    surveys: Sequence[Survey]
    basis: Callable[[Survey], Basis]
    errors: Mapping[str, ReductionError]

    def settings(self) -> dict[str, str]:
        """Every setting in force, by test; tests that failed have none."""
        sound = (one for one in self.surveys if not one.error and one.plan.id not in self.errors)
        return {one.plan.id: self.basis(one).settings for one in sound}


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
        self._records = KeptRecords()
        self._memory = Memory()
        self._made: dict[tuple[str, str, tuple[Stamp, ...]], Made] = {}
        self._load(progress or Silent())

    def _load(self, progress: Progress) -> None:
        text = CampaignText.read(self.path)
        campaign = load_campaign(self.path, text=text.text)
        inputs = _inputs(text, campaign)
        stamps = tuple(map(stamp_of, inputs))
        first = survey_campaign(campaign, progress=progress)
        first.kept.clear()
        # all of it, or what was there before
        self.text, self.campaign, self.surveys = text, campaign, first.surveys
        self._inputs, self._stamps = inputs, stamps
        self._made.clear()
        self._settings: dict[str, str] = {}

    @property
    def is_changed_on_disk(self) -> bool:
        """Whether campaign.toml, or a file that it names, is another than the one that was read."""
        is_same = CampaignText.read(self.path).digest == self.text.digest
        return not is_same or tuple(map(stamp_of, self._inputs)) != self._stamps

    def read_again(self) -> None:
        """Take campaign.toml, and what is found in its logs, as they are now."""
        self._load(Silent())

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

    def made(
        self, test: str, text: CampaignText, told: Callable[[str], None] = lambda text: None
    ) -> Made:
        """Reduce a test as a text says.

        Parameters
        ----------
        test : str
            Id of its product.
        text : CampaignText
            From `changed`, or as on the disk.
        told : callable
            Told of each stage that begins; what it raises ends the work.

        Returns
        -------
        made : Made
            Of a test that cannot be reduced with its error.

        Raises
        ------
        SettingsError
            If the text is not a campaign that could be run.
        """
        # marks or a log that changed meanwhile are not what an earlier answer was made from
        key = (test, text.digest, tuple(map(stamp_of, self._inputs)))
        known = self._made.pop(key, None)
        if known is None:
            known = self._reduced(test, text, told)
        self._made[key] = known
        while len(self._made) > _MOST_KEPT:
            self._made.pop(next(iter(self._made)))
        return known

    def _reduced(self, test: str, text: CampaignText, told: Callable[[str], None]) -> Made:
        begun = time.perf_counter()
        self._records.told = told
        told("loading the campaign")
        log = self.survey(test).plan.log
        now = self._surveyed(text, log, told)
        survey = next(one for one in now.surveys if one.plan.id == test)
        error = survey.error or now.errors.get(test)
        dataset, is_standing = None, False
        if error is None:
            told("reducing")
            try:
                basis = now.basis(survey)
                is_standing = self._is_standing(survey, basis)
                dataset, _ = dataset_of(
                    now.campaign, survey, basis, command=COMMAND, recall=self._memory
                )
            except Exception as failure:
                # one text of many that are tried, even where the failure is a defect here
                error = as_reduction_error(failure)
        also = () if text.digest == self.text.digest else self._also(now, test, told)
        said = "" if error is None else now.campaign.in_words(str(error))
        seconds = time.perf_counter() - begun
        # the record of a long log is kept once, and not with everything that was made of it
        return Made(replace(survey, located=None), dataset, said, seconds, is_standing, also)

    def _surveyed(self, text: CampaignText, log: str, told: Callable[[str], None]) -> _Surveyed:
        campaign = load_campaign(self.path, text=text.text)
        if list(campaign.tests) != list(self.campaign.tests):
            raise SettingsError("the tests of the campaign changed", needed="the same tests")
        told("finding phases and cycles")
        own = survey_log(campaign, log, reader=self._records)
        surveys: list[Survey] = []
        for one in self.surveys:
            if one.plan.log != log:
                surveys.append(one)
            elif own:
                surveys += own
                own = []
        models, errors = fit_strain_models(campaign, surveys)
        executor = Serial()
        kept = {log: executor.send([one for one in surveys if one.plan.log == log])}
        pulls, of_pulls = fit_pulls(
            campaign, FirstPass(surveys, kept), models, executor=executor, progress=Silent()
        )
        errors |= of_pulls
        failed = [one.plan.id for one in surveys if one.error or one.plan.id in errors]
        past = past_of(surveys, models)

        def basis(survey: Survey) -> Basis:
            return basis_of(campaign, survey, past, pulls=pulls, failed=failed)

        return _Surveyed(campaign, surveys, basis, errors)

    def _is_standing(self, survey: Survey, basis: Basis) -> bool:
        path = self._processed / f"{survey.plan.id}.nc"
        found = standing_product(
            path, survey, basis.settings, remarks=basis.remarks, failed=basis.failed
        )
        return found is not None

    def _also(self, now: _Surveyed, test: str, told: Callable[[str], None]) -> tuple[str, ...]:
        """Other tests whose settings in force are not those of the text on the disk."""
        told("looking at the other tests")
        if not self._settings:
            before = self._surveyed(self.text, self.survey(test).plan.log, told)
            self._settings = before.settings()
        new = now.settings()
        return tuple(
            one.plan.id
            for one in now.surveys
            if one.plan.id != test and self._settings.get(one.plan.id) != new.get(one.plan.id)
        )

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


def _inputs(text: CampaignText, campaign: Campaign) -> tuple[Path, ...]:
    """Every file that a campaign may be read from: those that its text and its tests name."""
    own = {campaign.folder / name for plan in campaign.tests.values() for name, _ in plan.files}
    return tuple(sorted({*text.named, *own, *campaign.copies.values()}))
