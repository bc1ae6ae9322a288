import numpy as np
import pytest
from export_lines import constant, line

from reduction.lines.deck_formats import FORMATS, FORMS, closeness_of, export_line


@pytest.mark.parametrize("to", [to for to in FORMS if to != "raft"])
def test_what_is_said_of_a_curve_is_what_its_header_says(to, tmp_path):
    (words,) = closeness_of(line(), to, None)
    error = words.split("by at most ")[1].replace(" %", " percent")
    *_, path = export_line(line(), to, tmp_path / "x.dat")
    bare = " ".join(path.read_text().replace("*", " ").replace("/", " ").replace("#", " ").split())
    assert f"greatest error {error}" in bare


def test_a_step_that_a_smooth_function_cannot_follow_is_doubtful():
    one = line(
        strain=np.array([0.0, 0.5, 0.5 + 1e-7, 1.0]), tension=np.array([0.0, 10.0, 1e3, 1.1e3])
    )
    assert closeness_of(one, "whoi-cable", None)[0].startswith("DOUBTFUL")
    assert "at most 0 N" in closeness_of(one, "whoi-cable", "table")[0]


def test_where_no_curve_is_thinned_nothing_is_said():
    told = {(to, form) for to, forms in FORMS.items() for form in forms}
    silent = {one for one in told if closeness_of(line(viscoelasticity=constant()), *one) == ()}
    dynamic = {"static-dynamic", "load-dependent", "syrope"}
    assert silent == {("moorpy", "library")} | {
        (to, form) for to in ("moordyn", "openfast") for form in dynamic if form in FORMS[to]
    }
    tables = [to for to in FORMATS if closeness_of(line(), to, None) == ()]
    # a line of RAFT is a straight one
    assert tables == [to for to in FORMATS if to not in FORMS or to == "raft"]
