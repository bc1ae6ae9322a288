"""Coverage-guided fuzzing of a reader, by atheris (libFuzzer).

    pip install atheris
    python tests/fuzz_readers.py tdms -max_total_time=600 -timeout=20 -rss_limit_mb=1000 CORPUS

The first word is a case of tests/fuzzcases.py (its log is replaced), or one of its other files,
such as marks.csv, or ``archive`` for one without the sum at its end.  What follows goes to libFuzzer; CORPUS is a folder of its own, to which the good
file is added.  An input that breaks the invariant is left as crash-..., timeout-... or oom-... .
"""

import sys
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import atheris

with atheris.instrument_imports(include=["reduction"]):
    from fuzzcases import CASES
    from secondreading import read_again
    from shortcampaign import write_short

    from reduction.archive.open import reading
    from reduction.batch.run_campaign import run_campaign
    from reduction.campaign.load import load_campaign
    from reduction.readers.read_log import read_record
    from reduction.record.errors import ReductionError

import numpy as np


def target_of(name, folder):
    """Function of the bytes of a file, and the good ones."""
    case = CASES.get(name) or CASES["marked"]
    file = case.log if name in CASES else name
    campaign_toml = case.write(folder)

    def record_of(campaign):
        plan = next(iter(campaign.tests.values()))
        files = [(campaign.file(n), campaign.layouts[layout], n) for n, layout in plan.files]
        return read_record(
            files, test_id=plan.id, specimens=plan.specimens, quality=plan.settings.quality
        )[0]

    def target(data):
        (folder / file).write_bytes(data)
        try:
            record = record_of(load_campaign(campaign_toml))
        except ReductionError as error:
            if error.exit_status == 1 or not str(error):
                raise
            return
        with np.errstate(all="ignore"):
            again = read_again(case.files | {file: data})
        for found, wanted in (
            (record.time, again.time),
            (record.crosshead_position, again.position),
            (record.tension[0], again.tension),
        ):
            known = np.isfinite(wanted)
            if found.shape != wanted.shape or not np.allclose(found[known], wanted[known], 1e-9):
                raise AssertionError("samples that the file does not say")

    return target, case.files[file]


def target_of_archive(folder):
    """Function of the bytes of an archive, which reads all of it, and good ones without the sum."""
    campaign = load_campaign(write_short(folder / "raw"))
    places = {"processed": folder / "processed", "reports": folder / "reports"}
    made = run_campaign(campaign, **places, clock=lambda: 0.0)
    good, _, _ = (made.processed / "A.nc").read_bytes().rpartition(b"\nsha256 of the bytes")
    path = folder / "A.nc"

    def target(data):
        path.write_bytes(data)
        try:
            with reading(path) as archive:
                archive.load()
        except ReductionError as error:
            if error.exit_status == 1 or not str(error):
                raise

    return target, good


def main():
    """Command line."""
    name, *options = sys.argv[1:]
    warnings.simplefilter("error")
    folders = [Path(option) for option in options if not option.startswith("-")]
    with TemporaryDirectory() as folder:
        target, good = (
            target_of_archive(Path(folder)) if name == "archive" else target_of(name, Path(folder))
        )
        for corpus in folders[:1]:
            corpus.mkdir(parents=True, exist_ok=True)
            (corpus / "good").write_bytes(good)
        atheris.Setup([sys.argv[0], *options], target)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
