"""Every check of the project's campaigns has a planted fault behind it, or a stated reason.

What was planted stands in raw/*/README.md, beside the generators and in truth/; the static test is
a real one, with the errors of its printed table.  The lag of 20 ms is in every log of the tethers
and stated as an error: what it does lies within the intervals.
"""

import json
import re
import shutil
from collections import Counter

import pytest
from commandruns import ROOT

CAMPAIGNS = {
    "tmt-synthetic": "synthetic", "nylon-synthetic": "nylon_campaign",
    "hose-synthetic": "hose_campaign", "buoy-technology-1997": "static",
}  # fmt: skip
# campaign, test or part, what is wrong with it, words of the check
PLANTED = (
    ("tmt-synthetic", "T-4-extended", "splices of one tether let out line from cycle 600 and 1,500",
     "new: the splices slipped at cycles 599 and 1,501"),
    ("tmt-synthetic", "overnight-hold", "the same, with marks from before them",
     "new: before this test the splices slipped by about 90 mm or more"),
    ("nylon-synthetic", "R05, experiment nylon", "amplitude greater than the mean: no tension in"
     " each cycle; said once, for its cycles, its three-parameter line and the plan of the runs",
     "goes slack in 13 of 13 cycles"),
    ("hose-synthetic", "comparison H64-dynamic", "cords that carry 1.4 times their slow load",
     "the prediction is below the test"),
    ("hose-synthetic", "comparison H68-dynamic", "cords that carry 1.4 times their slow load",
     "the shape of the difference has a probability of only"),
    ("hose-synthetic", "comparison H64-too-many", "four fitted numbers, of which a curve has two",
     "changes the curve by only 0.02 %"),
    ("hose-synthetic", "comparison H64-break", "one pull without a way back: above its mean curve",
     "the shape of the difference has a probability of only"),
    ("buoy-technology-1997", "static", "printed length and elongation of 1325 disagree",
     "1325: a length of 416.1 mm gives 167 %, but 151 % is recorded"),
    ("buoy-technology-1997", "static", "weight taken off at 1205 and length up",
     "1205: in 45 min the weight changed"),
)  # fmt: skip
# campaign, test or part, why the check is right, words of the check
JUSTIFIED = (
    ("tmt-synthetic", "T-4", "marks.csv has no mark on the way down: H could be 44 % off",
     "no mark was read during unloading"),
    ("nylon-synthetic", "experiment nylon", "runs were made in the order of their mean tension",
     "a factor follows the order of the runs"),
    ("nylon-synthetic", "experiment nylon", "a quadratic of H is negative inside the range",
     "this surface falls to"),
    ("hose-synthetic", "L-64", "the static cycles begin and end slack: amplitudes are no EA",
     "correct its zero and test again. 1 similar note in L-68"),
    ("hose-synthetic", "D-64", "no lag is stated, and 5 ms are 8 % of H",
     "the lag between tension and position is not stated"),
    ("hose-synthetic", "comparison H64-dynamic", "angle and cord load do the same to one curve",
     "The curve does not determine the fitted numbers"),
    ("hose-synthetic", "comparison H68-dynamic", "cord load and the others do the same to it",
     "The curve does not determine the fitted numbers"),
    ("hose-synthetic", "comparison H64-too-many", "said of each number that is not determined",
     "cord_load_scale is not determined"),
    ("hose-synthetic", "comparison H64-too-many", "said of each number that is not determined",
     "cord_strain_scale is not determined"),
    ("hose-synthetic", "comparison H64-too-many", "said of each number that is not determined",
     "dead_length_share is not determined"),
)  # fmt: skip


def rows_of(campaign, table=PLANTED + JUSTIFIED):
    return [(where, words) for name, where, _, words in table if name == campaign]


@pytest.fixture(params=CAMPAIGNS)
def campaign(request):
    """Name of a campaign, what it printed to check, and the status of each test."""
    run = request.getfixturevalue(CAMPAIGNS[request.param])
    finished = json.loads((run.processed / "finished-run.json").read_text(encoding="utf-8"))
    said = run.said
    parts = [("experiment ", "experiments"), ("comparison ", "comparisons"), ("", "tests")]
    status = {
        f"{kind}{one['id']}": one["status"] for kind, key in parts for one in said.get(key) or ()
    }
    return request.param, finished["answers"]["doubts"], status


def test_planted_faults_are_checks_and_every_other_check_is_justified(campaign):
    name, doubts, status = campaign
    found = Counter(
        next((row for row in rows_of(name) if row[0] == where and row[1] in words), (where, words))
        for where, words in map(tuple, doubts)
    )
    assert found == Counter(rows_of(name))
    doubted = {test for where, _ in rows_of(name) for test in where.split(", ")}
    similar = re.findall(r"\. \d+ similar notes? in (.+)", "\n".join(words for _, words in doubts))
    doubted |= {test for names in similar for test in names.split(", ")}
    assert {test for test, one in status.items() if one == "check"} == doubted


def test_every_campaign_has_a_planted_fault():
    assert {name for name, *_ in PLANTED} == set(CAMPAIGNS)


@pytest.mark.parametrize(("stated", "is_said"), [("", True), ('splice_friction = "2 %"\n', False)])
def test_friction_that_is_stated_is_not_asked_for_even_where_it_is_the_default(
    command, tmp_path, stated, is_said
):
    folder = shutil.copytree(
        ROOT / "raw/tmt-synthetic", tmp_path / "logs", ignore=shutil.ignore_patterns("truth")
    )
    text = (folder / "campaign.toml").read_text("utf-8")
    text = text.replace("[uncertainty]\n", f"[uncertainty]\n{stated}", 1)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    done = command("run", folder / "campaign.toml", "--test", "T-4", cwd=tmp_path)
    assert ("or state splice_friction" in done.stdout) is is_said
