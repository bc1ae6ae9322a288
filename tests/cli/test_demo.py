"""The campaigns that come with the package are copied and run; nothing that is there is lost."""

import pytest
from commandruns import ROOT, answered
from shortcampaign import write_short

from reduction.cli import campaigns


@pytest.fixture
def one_short(tmp_path, monkeypatch):
    """A package whose one campaign takes a second."""
    monkeypatch.setattr(campaigns, "_PACKAGE", tmp_path / "reduction")
    monkeypatch.setattr(campaigns, "_DEMO_NAMES", ("short",))
    write_short(tmp_path / "reduction" / "demo" / "short")
    return tmp_path


def test_the_campaigns_of_a_checkout_are_those_of_raw():
    assert campaigns._demo_campaigns() == ROOT / "raw"
    for name in campaigns._DEMO_NAMES:
        assert (ROOT / "raw" / name / "campaign.toml").is_file()


def test_each_campaign_is_copied_and_run(one_short, command):
    folder = one_short / "Prüf stand ü"
    done = command("demo", folder, "--json")
    (answer,) = answered(done)["campaigns"]
    assert {test["id"] for test in answer["tests"]} == {"A", "B"}
    assert (folder / "raw" / "short" / "A.csv").is_file()
    assert (folder / "processed" / "short" / "A.nc").is_file()
    assert (folder / "reports" / "short" / "index.html").is_file()


def test_a_campaign_that_is_there_is_left_as_it_is(one_short, command):
    mine = one_short / "work" / "raw" / "short" / "campaign.toml"
    mine.parent.mkdir(parents=True)
    mine.write_text("mine")
    done = command("demo", one_short / "work")
    assert done.returncode == 2
    assert "campaigns are there already; found short" in done.stderr
    assert mine.read_text() == "mine" and len(list(mine.parent.iterdir())) == 1
