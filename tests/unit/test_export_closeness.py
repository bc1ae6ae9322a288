import re

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


@pytest.mark.parametrize(
    ("to", "form"),
    [("moordyn", "static-dynamic"), ("openfast", "static-dynamic"), ("moorpy", "library")],
)
def test_a_line_of_one_stiffness_says_how_it_gets_its_mean_tension(to, form, tmp_path):
    """T = a e + b e^2 has 20 kN at 1/30, and the tangent there, 800 kN, at 1/40.

    With the length, and the stiffness, f times as large the spring is at rest where the tangent
    meets zero: L f (1 + T / (f K_0)) = L (1 + 1/30), so that f = 1 + 1/30 - 1/40.
    """
    strain = np.linspace(0.0, 0.06, 601)
    rope = line(
        strain=strain,
        tension=400e3 * strain + 6e6 * strain**2,
        viscoelasticity=constant(
            static_stiffness=800e3, dynamic_stiffness=1500e3, mean_tension=20e3
        ),
        rated_break_strength=100e3,
    )
    (said,) = closeness_of(rope, to, form)
    *_, path = export_line(rope, to, tmp_path / "x.dat", form=form)
    bare = " ".join(path.read_text().replace("#", " ").split())
    assert said in bare
    share = float(re.search(r"BA by ([\d.]+) and divide", said)[1])
    assert share == pytest.approx(1 + 1 / 30 - 1 / 40, abs=5e-6)
    assert "33 percent above the mean" in said


def test_a_line_that_is_straight_from_zero_has_nothing_to_correct():
    strain = np.linspace(0.0, 0.06, 61)
    straight = line(
        strain=strain,
        tension=2e4 * strain,
        viscoelasticity=constant(mean_tension=800.0),
    )
    (said,) = closeness_of(straight, "moordyn", "static-dynamic")
    assert "Multiply" not in said
