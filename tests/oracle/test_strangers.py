"""The laws that the coverage studies are judged by keep what they promise."""

import pytest
from strangers import LAWS
from strangers.check import check_law, check_lines, check_materials

OF_EACH_KIND = {
    "tether-ratio-both", "rope-creep-levels", "line-falling", "hold-settling",
    "loop-unequal-elastic", "train-both",
}  # fmt: skip


def test_elements_do_the_work_of_their_closed_forms():
    check_materials()
    check_lines()


@pytest.mark.parametrize(
    "law",
    [one if one in OF_EACH_KIND else pytest.param(one, marks=pytest.mark.nightly) for one in LAWS],
)
def test_a_law_agrees_with_its_logs_and_states_its_errors(law, tmp_path):
    check_law(law, 1, tmp_path)
