"""The page of each campaign, as a browser shows it."""

import pytest

CAMPAIGNS = ("tmt-synthetic", "nylon-synthetic", "hose-synthetic", "buoy-technology-1997")


@pytest.mark.parametrize("name", CAMPAIGNS)
def test_a_page_opens_without_an_error_or_a_request(name, campaigns, visit):
    shown = visit(campaigns(name).reports / "index.html")
    shown.page.wait_for_function("window.Plotly")
    assert shown.errors == []
    assert shown.beyond == []
