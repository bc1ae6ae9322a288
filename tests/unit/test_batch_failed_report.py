"""A run of which no test could be reduced has a page all the same: it says so, and why."""

from manytests import write_many

from reduction.batch.run_campaign import run_campaign
from reduction.campaign.load import load_campaign


def run(campaign, folder):
    return run_campaign(
        load_campaign(campaign), processed=folder / "p", reports=folder / "r",
        clock=lambda: 0.0, command="reduction run campaign.toml",
    )  # fmt: skip


def test_where_every_test_failed_the_page_says_that_and_why(tmp_path):
    campaign = write_many(tmp_path / "raw", 1)
    (campaign.parent / "T01.csv").write_text("time_s,crosshead_ft,load_lb\n0,no number,1\n")
    page = tmp_path / "r" / "many" / "index.html"
    page.parent.mkdir(parents=True)
    page.write_text("of a run whose archives were taken away")
    found = run(campaign, tmp_path)
    assert found.exit_status == 3
    assert found.report == page
    text = page.read_text(encoding="utf-8")
    assert "T01" in text and "no number" in text and "Failures" in text
    # it had an empty table, "0 specimens", and spoke of sections that are not there
    assert "No test could be reduced, so there are no results." in text
    assert "in its section" not in text and "specimens</a>" not in text
    assert "Specimens before their first test" not in text
    assert found.tables == ()
