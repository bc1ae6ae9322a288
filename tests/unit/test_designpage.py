"""The design-value page as a file: what stands in it, what is read again, what cannot be read."""

import json
import re
import shutil
from functools import partial
from importlib.resources import files
from urllib.parse import unquote

import numpy as np
import pytest
from manytests import write_many
from nopage import leave_out_page

from reduction.archive.open import reading
from reduction.batch import run_campaign as batch_run
from reduction.campaign.load import load_campaign
from reduction.cli.campaigns import _refresh_design_page
from reduction.cli.output import CommandOutput
from reduction.lines.archive_source import lines_of_archive
from reduction.lines.published_source import published_sources
from reduction.pages import design_values as made
from reduction.pages import design_values as read
from reduction.pages.design_values import _json_text, _line_data
from reduction.record.errors import ArchiveError

DATA = re.compile(r'<script type="application/json" id="data">(.*?)</script>', re.DOTALL)


def data_of(path):
    return json.loads(DATA.search(path.read_text(encoding="utf-8"))[1])


@pytest.fixture(scope="module")
def products(tmp_path_factory):
    """A folder of products with one campaign of small tests: T01, T02.a and T02.b."""
    folder = tmp_path_factory.mktemp("products")
    campaign = load_campaign(write_many(folder / "many", 2))
    with pytest.MonkeyPatch.context() as patch:
        leave_out_page(patch)
        batch_run.run_campaign(
            campaign, processed=folder / "processed", reports=folder / "r", clock=lambda: 0.0
        )
    return folder / "processed"


@pytest.fixture
def processed(products, tmp_path):
    return shutil.copytree(products, tmp_path / "processed")


@pytest.fixture
def opened():
    """Names of the archives that are opened by a page that is made with `write`."""
    return []


@pytest.fixture
def write(opened):
    def opener(path):
        opened.append(path.name)
        return reading(path)

    return partial(made.write_design_page, opener=opener)


def test_numbers_keep_every_bit(products):
    (line,) = lines_of_archive(products / "many" / "T01.nc")
    kept = json.loads(json.dumps(_line_data(line)))
    for curve, own in zip(line.curves, kept["curves"], strict=True):
        for name in ("at", "value", "standard_uncertainty", "contribution"):
            assert np.array(own[name]).tobytes() == getattr(curve, name).tobytes()
        assert [
            np.inf if one[3] == "inf" else one[3] for one in own["component"]
        ] == [one.degrees_of_freedom for one in curve.component]  # fmt: skip
    for line in published_sources().values():
        kept = json.loads(json.dumps(_line_data(line)))
        for name, surface in line.surfaces.items():
            own = kept["surfaces"][name]
            assert np.array(own["coefficient"]).tobytes() == surface.coefficient.tobytes()
            assert (
                np.array(own["covariance_factor"]).tobytes() == surface.covariance_factor.tobytes()
            )


def test_lines_are_named_as_in_a_look_up_of_the_folder(processed, tmp_path):
    path = made.write_design_page(processed, tmp_path / "reports")
    assert path == tmp_path / "reports" / "design-values.html"
    (campaign,) = data_of(path)["campaigns"]
    assert campaign["name"] == "many"
    assert campaign["names"] == ["T01 one", "T02.a one", "T02.b one"]
    assert path.stat().st_size < 3_000_000


def test_only_archives_that_changed_are_read_again(processed, tmp_path, opened, write):
    first = write(processed, tmp_path).read_bytes()
    assert opened == ["T01.nc", "T02.a.nc", "T02.b.nc"]
    opened.clear()
    assert write(processed, tmp_path).read_bytes() == first
    assert opened == []
    shutil.copy(processed / "many" / "T01.nc", processed / "many" / "T02.a.nc")
    write(processed, tmp_path)
    assert opened == ["T02.a.nc"]


@pytest.mark.parametrize(
    "text", ["", "nothing", '<script type="application/json" id="data">[1]</script>',
             '<script type="application/json" id="data">{"format": 0, "version": "0"}</script>'],
    ids=["empty", "no data", "other data", "other format"],
)  # fmt: skip
def test_a_page_that_is_not_ours_is_replaced(processed, tmp_path, opened, write, text):
    (tmp_path / made.DESIGN_PAGE_NAME).write_text(text)
    write(processed, tmp_path)
    assert len(opened) == 3


def test_an_archive_that_cannot_be_read_is_named_and_the_others_stand(processed, tmp_path):
    (processed / "many" / "T01.nc").write_bytes(b"no archive")
    (processed / "empty").mkdir()
    found = data_of(made.write_design_page(processed, tmp_path))
    ((campaign, name, text),) = found["faults"]
    assert (campaign, name) == ("many", "T01.nc")
    assert text.startswith("T01.nc cannot be read as a netCDF file")
    assert found["campaigns"][0]["names"] == ["T02.a one", "T02.b one"]


def test_a_report_that_stands_beside_the_page_is_linked(processed, tmp_path):
    name = "many & <b> 50%"
    (processed / "many").rename(processed / name)
    reports = tmp_path / "reports"
    assert data_of(made.write_design_page(processed, reports))["reports"] == {}
    (reports / name).mkdir()
    (reports / name / "index.html").write_text("a report")
    page = made.write_design_page(processed, reports)
    (address,) = data_of(page)["reports"].values()
    assert (page.parent / unquote(address)).read_text() == "a report"
    assert address == "many%20%26%20%3Cb%3E%2050%25/index.html"


def test_a_folder_that_no_run_left_is_no_campaign(processed, tmp_path):
    (processed / "many" / "status.csv").unlink()
    found = data_of(made.write_design_page(processed, tmp_path))
    assert found["campaigns"] == []
    assert len(found["published"]) == len(published_sources())


def test_a_run_that_ends_meanwhile_is_on_the_page(processed, tmp_path, monkeypatch):
    whole, times = made.write_text_atomically, []

    def write(path, text):
        whole(path, text)
        if not times:
            shutil.copytree(processed / "many", processed / "other")
        times.append(path)

    monkeypatch.setattr(made, "write_text_atomically", write)
    found = data_of(made.write_design_page(processed, tmp_path))
    assert len(times) == 2
    assert [one["name"] for one in found["campaigns"]] == ["many", "other"]


def test_what_has_no_room_is_told_and_not_read(processed, tmp_path, monkeypatch, opened, write):
    shutil.copytree(processed / "many", processed / "newer")
    for path in (processed / "newer").glob("*.nc"):
        path.touch()
    before = read._read_campaigns(processed, room=made.MOST_BYTES)
    sizes = [len(_json_text(one)) for one in before[1].files.values()]
    opened.clear()
    monkeypatch.setattr(made, "MOST_BYTES", sizes[0] + sizes[1] + 100)
    found = data_of(write(processed, tmp_path))
    kept = {one["name"]: one["names"] for one in found["campaigns"]}
    assert kept == {"newer": ["T01 one", "T02.a one"], "many": []}
    assert found["left_out"] == [["many", 3], ["newer", 1]]
    assert opened == ["T01.nc", "T02.a.nc", "T02.b.nc"]


def test_every_script_is_on_the_page_once():
    there = {
        one.name for one in files("reduction.pages").joinpath("design_values_static").iterdir()
    }
    assert sorted(made._SCRIPTS) == sorted(there - {"page.css"})


def test_a_full_page_is_below_three_megabytes():
    assert len(made._render_design_page().encode()) + made.MOST_BYTES < 3_000_000


def test_no_page_is_made_of_copies(processed, tmp_path):
    output = CommandOutput(quiet=True, names={str(processed): "s3://bucket/processed"})
    assert _refresh_design_page(processed, tmp_path, output) is None
    output = CommandOutput(quiet=True)
    assert _refresh_design_page(processed, tmp_path, output) == str(
        tmp_path / made.DESIGN_PAGE_NAME
    )


def test_a_disk_that_refuses_is_told(processed, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ArchiveError, match="cannot be written"):
        made.write_design_page(processed, tmp_path / "file")
