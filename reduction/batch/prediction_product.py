"""Writes the predictions and comparisons of a campaign."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from reduction import __version__
from reduction.archive.atomic_write import take_away
from reduction.archive.campaign_products import (
    NamedComparison,
    comparisons_to_dataset,
    predictions_to_dataset,
)
from reduction.archive.open import Opener, as_kept, keep_written, reading
from reduction.archive.shared_errors import curve_errors_of
from reduction.archive.test_dataset import stored_cycles
from reduction.archive.uncertainty_budget import break_in_cycles
from reduction.archive.write import write_archive
from reduction.batch.campaign_status import PartStatus
from reduction.batch.reuse import NOT_REDUCED
from reduction.campaign.plan import Campaign, ComparisonPlan
from reduction.prediction.hose_comparison import compare_record, loading_of
from reduction.prediction.hose_prediction import HosePlan, PredictedHose, predict_from_plan
from reduction.readers.raw_log import hash_source
from reduction.record.errors import DataError, ReductionError
from reduction.record.measurement import Integers, Origin, Source, Step
from reduction.record.notes import Note, note


def write_predictions(
    campaign: Campaign, folder: Path, *, command: str, opener: Opener
) -> list[PartStatus]:
    """Predict the hoses of a campaign, and write them as one archive."""
    hoses, statuses = [], []
    for plan in campaign.hoses.values():
        try:
            hose = predict_from_plan(plan)
        except ReductionError as error:
            text = f"hose '{plan.name}': {error}"
            statuses.append(PartStatus(plan.name, "failed", error.exit_status, text))
            continue
        hoses.append(hose)
        status = "check" if any(one.severity == "warning" for one in hose.notes) else "predicted"
        message = "; ".join([_in_one_line(hose), *map(str, hose.notes[:1])])
        statuses.append(PartStatus(plan.name, status, 0, message))
    if hoses:
        write_hoses(
            hoses,
            folder / "predictions.nc",
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            source=hash_source(campaign.path, campaign.path.name),
            command=command,
            opener=opener,
        )
    return statuses


def write_hoses(
    hoses: Sequence[PredictedHose],
    path: Path,
    *,
    campaign_id: str,
    attributes: Mapping[str, str],
    source: Source,
    command: str,
    opener: Opener = reading,
) -> None:
    """Write predicted hoses as one archive."""
    dataset = hoses_dataset(
        hoses, campaign_id=campaign_id, attributes=attributes, source=source, command=command
    )
    keep_written(opener, path, as_kept(write_archive(dataset, path)))


def hoses_dataset(
    hoses: Sequence[PredictedHose],
    *,
    campaign_id: str,
    attributes: Mapping[str, str],
    source: Source,
    command: str,
) -> xr.Dataset:
    """Predicted hoses as an archive dataset."""
    settings = {hose.plan.name: _settings_of_hose(hose.plan) for hose in hoses}
    return predictions_to_dataset(
        hoses,
        origin=Origin(
            campaign_id=campaign_id,
            attributes=attributes,
            sources=[source],
            steps=[Step("predict", _in_one_line(hose)) for hose in hoses],
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False),
            version=__version__,
            command=command,
        ),
    )


def _settings_of_hose(plan: HosePlan) -> dict[str, Any]:
    """All numbers of a plan in SI, for JSON."""
    found: dict[str, Any] = _plain(asdict(plan))
    return found


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    return None if isinstance(value, float) and np.isnan(value) else value


def _in_one_line(hose: PredictedHose) -> str:
    design, events = hose.plan.design, hose.events
    return (
        f"{hose.plan.name}: {np.degrees(float(design.wrap_angle)):.4g} deg, {design.rubber_law} "
        f"rubber, cords pick up at {100 * float(events.pick_up.strain):.4g} %, working load "
        f"{float(events.working.tension):.4g} N at {100 * float(events.working.strain):.4g} %"
    )


def write_comparisons(
    campaign: Campaign,
    folder: Path,
    *,
    failed: Collection[str],
    waiting: Collection[str],
    command: str,
    opener: Opener = reading,
) -> list[PartStatus]:
    """Make the requested comparisons from the archives of the tests, and write one archive."""
    held = all(plan.measured in waiting for plan in campaign.comparisons.values())
    stands = held and (folder / "comparisons.nc").exists()
    kept = "; comparisons.nc is of an earlier run" if stands else ""
    done: list[NamedComparison] = []
    statuses: list[PartStatus] = []
    paths: dict[str, Path] = {}
    for plan in campaign.comparisons.values():
        path = folder / f"{plan.measured}.nc"
        if plan.measured in waiting:
            text = f"not compared: {plan.measured} is {NOT_REDUCED}{kept}"
            statuses.append(PartStatus(plan.name, "no_work", 0, text))
            continue
        try:
            if plan.measured in failed:
                raise DataError(f"test '{plan.measured}' failed: there is no curve of it")
            named = compare_archive(path, campaign.hoses[plan.predicted], plan, opener)
        except ReductionError as error:
            text = f"comparison '{plan.name}': {error}"
            statuses.append(PartStatus(plan.name, "failed", error.exit_status, text))
            continue
        done.append(named)
        paths[path.name] = path
        status = "check" if any(one.severity == "warning" for one in named.notes) else "compared"
        message = f"{plan.name}: {named.comparison.validation.verdict}"
        statuses.append(PartStatus(plan.name, status, 0, message))
    old = folder / "comparisons.nc"
    if old.is_file() and not done and not any(one.status == "no_work" for one in statuses):
        take_away(old)
    if done:
        written = write_named(
            done,
            old,
            hoses={one.hose: campaign.hoses[one.hose] for one in done},
            campaign_id=campaign.id,
            attributes=campaign.attributes,
            sources=[
                hash_source(campaign.path, campaign.path.name),
                *(hash_source(path, path.name) for path in paths.values()),
            ],
            command=command,
        )
        keep_written(opener, old, as_kept(written))
    return statuses


def compare_archive(
    path: Path, hose: HosePlan, plan: ComparisonPlan, opener: Opener = reading
) -> NamedComparison:
    """Compare the archive of a test with a hose."""
    with opener(path) as archive:
        missing = [name for name in ("strain", "tension", "specimen") if name not in archive]
        if missing:
            raise DataError(
                f"{path} holds no curve of tension against strain",
                found=f"no {' and no '.join(missing)}",
                needed="the archive of a reduced test with position and tension",
            )
        specimen, index = _specimen(path, archive, plan.specimen)
        _require_hose(path, archive, index)
        kind = archive.attrs["test_kind"]
        shared, notes = curve_errors_of(archive, index)
        gauge = _pressure(archive, index)
        if gauge.get("fill_pressure_standard_uncertainty") == 0:
            notes += (note("pressure-gauge-counts-as-exact"),)
        comparison = compare_record(
            hose,
            archive.variables["strain"].values[index],
            archive.variables["tension"].values[index],
            loading=plan.loading or loading_of(kind),
            cycle_number=_numbers(archive) if "cycle_number" in archive else None,
            branch=archive.variables["branch"].values if "branch" in archive else None,
            # a pull has no break-in cycles
            break_in_cycles=break_in_cycles(archive) if "cycle_number" in archive else 0,
            shared=shared,
            calibrate=plan.calibrate,
            **gauge,
        )
        comparison = replace(comparison, notes=(*notes, *_of_part(archive), *comparison.notes))
        if plan.loading is None and comparison.measured.loading == "dynamic":
            assumed = note("taken-as-dynamic", kind=kind)
            comparison = replace(comparison, notes=(assumed, *comparison.notes))
        return NamedComparison(
            plan.name, archive.attrs["test"], specimen, hose.name, comparison,
            is_synthetic=archive.attrs.get("synthetic") == "yes",
        )  # fmt: skip


def _pressure(archive: xr.Dataset, index: int) -> dict[str, Any]:
    """Logged fill pressure of a test, and the zero error of its gauge."""
    if "fill_pressure" not in archive:
        return {}
    spread = float(archive.variables["fill_pressure_standard_uncertainty"].values[index])
    return {
        "fill_pressure": archive.variables["fill_pressure"].values[index],
        "fill_pressure_standard_uncertainty": spread if np.isfinite(spread) else 0.0,
    }


def _numbers(archive: xr.Dataset) -> Integers:
    """Cycle of each sample; 0 at the end of a cycle whose other samples are no longer stored."""
    number: Integers = archive.variables["cycle_number"].values
    if "sample_index" not in archive:
        return number
    return np.where(np.isin(number, stored_cycles(archive)), number, 0)


def _of_part(archive: xr.Dataset) -> tuple[Note, ...]:
    """Notes for an archive with only some of the samples."""
    if "sample_index" not in archive:
        return ()
    return (note("from-stored-samples", samples=archive.attrs["stored_samples"]),)


def _require_hose(path: Path, archive: xr.Dataset, index: int) -> None:
    kind = (
        str(archive.variables["specimen_kind"].values[index]) if "specimen_kind" in archive else ""
    )
    if kind not in ("", "stretch hose"):
        raise DataError(
            f"{path} is of no stretch hose", found=kind,
            needed='specimens.NAME.kind = "stretch hose"',
        )  # fmt: skip


def _specimen(path: Path, archive: xr.Dataset, wanted: str) -> tuple[str, int]:
    names = [str(name) for name in archive.variables["specimen"].values]
    if not wanted and len(names) == 1:
        return names[0], 0
    if wanted not in names:
        raise DataError(
            f"{path} has no specimen '{wanted}'" if wanted else f"{path} has several specimens",
            needed="specimen = one of " + ", ".join(names),
        )
    return wanted, names.index(wanted)


def write_named(
    done: Sequence[NamedComparison],
    path: Path,
    *,
    hoses: Mapping[str, HosePlan],
    campaign_id: str,
    attributes: Mapping[str, str],
    sources: Sequence[Source],
    command: str,
) -> xr.Dataset:
    """Write comparisons as one archive."""
    settings: dict[str, Any] = {
        "hoses": {name: _settings_of_hose(plan) for name, plan in hoses.items()},
        "comparisons": {
            one.name: {
                "test": one.test,
                "specimen": one.specimen,
                "hose": one.hose,
                "loading": one.comparison.measured.loading,
                "calibrate": []
                if one.comparison.calibration is None
                else list(one.comparison.calibration.parameter),
            }
            for one in done
        },
    }
    dataset = comparisons_to_dataset(
        done,
        origin=Origin(
            campaign_id=campaign_id,
            attributes=attributes,
            sources=sources,
            steps=[
                Step("compare", f"{one.name}: {one.comparison.validation.verdict}") for one in done
            ],
            settings_json=json.dumps(settings, sort_keys=True, ensure_ascii=False),
            version=__version__,
            command=command,
        ),
    )
    return write_archive(dataset, path)
