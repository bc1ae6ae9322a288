"""What holds for the numbers of every paper that is reproduced from its equations."""

from functools import cache

import pytest
from misprinted import verdicts_of_misprints

from reduction.published import wang_2022, whoi_2004_06, zhang_2015
from reduction.published.printed_cells import cells_of, errata_of

PAPERS = {"Wang-2022": wang_2022, "WHOI-2004-06": whoi_2004_06, "Zhang-2015": zhang_2015}
# of Wang two limits, and the words of one ratio, hold no digit that could be changed
N_MISPRINTS = {"Wang-2022": 27, "WHOI-2004-06": 33, "Zhang-2015": 189}


@cache
def items(paper):
    return PAPERS[paper].items()


@pytest.mark.parametrize("paper", PAPERS)
def test_every_cell_has_its_item_in_its_place(paper):
    assert [item.cell for item in items(paper)] == list(cells_of(paper))


@pytest.mark.parametrize("paper", PAPERS)
def test_each_erratum_is_shown_by_a_cell(paper):
    shown = {item.cell.erratum for item in items(paper)} - {""}
    assert shown == {one.id for one in errata_of(paper)}


@pytest.mark.parametrize("paper", PAPERS)
def test_a_changed_digit_is_found(paper):
    verdicts = verdicts_of_misprints(paper, PAPERS[paper]._answers())
    assert {key for key, verdict in verdicts.items() if verdict != "unexplained"} == set()
    assert len(verdicts) == N_MISPRINTS[paper]
