"""Neither place, zone, locale nor person changes a byte of a product (synthetic data)."""

import hashlib
import os
import shlex
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import netCDF4
import pytest
from commandruns import reduction
from smallcampaign import CAMPAIGN, write_logs

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import same_bytes

from reduction import __version__

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign") / "small"
    write_logs(folder)
    tests = [
        f'[tests.{name}]\nfile = "{name}.csv"\norder = {order}\n'
        for order, name in enumerate("AB", start=1)
    ]
    text = "".join([CAMPAIGN, 'strain = { marks = "marks.csv" }\n', *tests])
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.skipif(os.name == "nt", reason="locales and permissions are those of POSIX")
@pytest.mark.parametrize(
    "there",
    [
        # with -OO Python compiles every library again
        pytest.param(replace(same_bytes.ALL_AT_ONCE, python_options=()), id="compiled before"),
        pytest.param(same_bytes.ALL_AT_ONCE, id="all at once"),
    ],
)
@pytest.mark.nightly
def test_other_surroundings_change_no_byte_of_any_product(there, campaign, tmp_path):
    found = same_bytes.locales(["tr_TR.UTF-8"], tmp_path / "locales")
    environment = {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1", **found}
    here, elsewhere = (
        same_bytes.run(campaign, one, tmp_path / str(number), environment=environment)
        for number, one in enumerate((same_bytes.SURROUNDINGS[0], there))
    )
    assert {"processed/small/A.nc", "reports/small/index.html", "reports/design-values.html",
            "processed/small/status.csv"} <= here.keys()  # fmt: skip
    assert same_bytes.differences(here, elsewhere) == []


@pytest.fixture(scope="module")
def products(campaign, tmp_path_factory):
    folder = tmp_path_factory.mktemp("products")
    done = reduction("run", campaign / "campaign.toml", cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder / "processed" / "small"


def test_what_an_archive_says_of_itself_makes_it_again(campaign, products, tmp_path):
    with netCDF4.Dataset(products / "B.nc") as archive:
        said = {name: archive.getncattr(name) for name in archive.ncattrs()}
    assert said["software_version"] == __version__
    heap = {hashlib.sha256(log.read_bytes()).hexdigest(): log for log in campaign.glob("*.csv")}
    again = tmp_path / "again"
    again.mkdir()
    for name, digest in zip(
        said["raw_file"].split("\n"), said["raw_file_sha256"].split("\n"), strict=True
    ):
        shutil.copy(heap[digest], again / name)
    # a strain model rests on the marks of all tests, and earlier tests on those before them
    for name in ("campaign.toml", "marks.csv", "A.csv"):
        shutil.copy(campaign / name, again / name)
    _, *arguments = shlex.split(said["command"])
    done = reduction(*arguments, cwd=again)
    assert done.returncode == 0, done.stderr
    made = again / "processed" / "small" / "B.nc"
    assert made.read_bytes() == (products / "B.nc").read_bytes()
