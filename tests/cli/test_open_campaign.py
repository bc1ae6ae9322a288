"""What docs/archive.md shows of the synthetic campaign is what a reader of its products gets."""

import contextlib
import doctest
import re
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import reduction

PAGE = Path(__file__).parents[2] / "docs" / "archive.md"
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S)


def test_the_examples_of_the_page_give_what_it_shows(synthetic):
    shown = "\n".join(block for block in BLOCKS if block.startswith(">>>"))
    example = doctest.DocTestParser().get_doctest(shown, {}, PAGE.name, str(PAGE), 0)
    with contextlib.chdir(synthetic.processed.parents[1]):
        failed, tried = doctest.DocTestRunner().run(example)
    assert tried == shown.count(">>>")
    assert failed == 0


@pytest.mark.nightly
@pytest.mark.skipif(find_spec("dask") is None, reason="Dask is not installed")
def test_the_dask_example_gives_the_highest_stress(synthetic):
    (block,) = (block for block in BLOCKS if not block.startswith(">>>"))
    names = {"reduction": reduction}
    with contextlib.chdir(synthetic.processed.parents[1]):
        exec(block, names)  # noqa: S102  # the page's own example
    with reduction.open_campaign(synthetic.processed / "T-4-extended.nc") as test:
        expected = np.nanmax(test["nominal_stress"].values, axis=1)
    np.testing.assert_array_equal(names["highest"].values, expected)


def test_every_archive_of_the_campaign_is_a_node(synthetic):
    with reduction.open_campaign(synthetic.processed) as campaign:
        assert set(campaign.children) == {one.stem for one in synthetic.processed.glob("*.nc")}
        assert campaign.attrs["synthetic"] == "yes"
