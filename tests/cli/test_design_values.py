"""A run and a report leave the design-value page of the folder of products that they wrote to."""

import json

import pytest
from commandruns import reduction
from manytests import run, write_many

pytestmark = pytest.mark.slow


def test_a_run_and_a_report_write_the_page(tmp_path):
    campaign = write_many(tmp_path / "many", 1)
    status, said, _ = run(campaign, tmp_path, "--json")
    assert status == 0
    page = tmp_path / "reports" / "design-values.html"
    assert json.loads(said)["design_values"] == str(page)
    text = page.read_text(encoding="utf-8")
    assert '"name":"many"' in text
    # the products of one campaign are in the folder of all
    done = reduction(
        "report", tmp_path / "processed" / "many", "--reports", tmp_path / "again", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    page = tmp_path / "again" / "design-values.html"
    assert f"design values: {page}" in done.stdout
    # this run left no report of the campaign; where there is one, either page leads to the other
    linked = text.replace('"reports":{}', '"reports":{"many":"many/index.html"}')
    assert page.read_text(encoding="utf-8") == linked != text
    report = (tmp_path / "again" / "many" / "index.html").read_text(encoding="utf-8")
    assert 'href="../design-values.html"' in report
    for path in (tmp_path / "processed").glob("*/T01.nc"):
        path.write_bytes(b"no archive")
    done = reduction(
        "report", tmp_path / "processed", "--reports", tmp_path / "again", cwd=tmp_path
    )
    assert "T01.nc cannot be read as a netCDF file" in page.read_text(encoding="utf-8")
