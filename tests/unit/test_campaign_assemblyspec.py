import numpy as np
import pytest

from reduction.campaign.assembly_spec import load_assembly_case
from reduction.record.errors import SettingsError

LBF = 4.4482216152605


def load(tmp_path, text):
    path = tmp_path / "mooring.toml"
    path.write_text(text, encoding="utf-8")
    return load_assembly_case(path)


def test_every_key_comes_in_si(tmp_path):
    case = load(
        tmp_path,
        """
[assembly]
free_lengths = ["8 m", "320 in"]
rated_break_strength = "800 lbf"
[assembly.curve]
source = ["a.nc", "b.nc"]
specimen = "new"
branch = "ascending"
precedence = ["static", "cyclic"]
[assembly.splices]
length = "120 cm"
strain = "40 %"
at_tension = "200 lbf"
exponent = 0.85
[[assembly.parts]]
name = "nylon"
length = "10 ft"
spring_constant = "20 kN"
[[assembly.parts]]
length = "1 m"
[[assembly.working]]
total_length = "20 m"
tension_amplitude = "50 lbf"
""",
    )
    assert case.name == "mooring" and case.n_tethers == 2
    assert case.free_lengths == pytest.approx((8.0, 8.128))
    assert np.isnan(case.tolerance)
    assert case.rated_break_strength == pytest.approx(800 * LBF)
    assert (case.sources, case.specimen, case.branch) == (("a.nc", "b.nc"), "new", "ascending")
    assert case.rule.precedence == ("static", "cyclic")
    assert (case.splices.length, case.splices.strain) == pytest.approx((1.2, 0.4))
    assert (case.splices.at_tension, case.splices.exponent) == pytest.approx((200 * LBF, 0.85))
    assert [part.name for part in case.parts] == ["nylon", "part 2"]
    assert case.parts[0].length_at(2e3) == pytest.approx(3.048 * 1.1)
    assert case.parts[1].length_at(2e3) == pytest.approx(1.0)
    (level,) = case.working
    assert (level.quantity, level.value) == ("total_length", 20.0)
    assert level.tension_amplitude == pytest.approx(50 * LBF)


def test_the_shortest_specification_leaves_the_rest_to_the_tests(tmp_path):
    case = load(tmp_path, '[assembly]\nn_tethers = 3\n[assembly.curve]\nsource = "used"\n')
    assert (case.n_tethers, case.free_lengths, case.splices) == (3, (), None)
    assert case.rule.precedence == ("cyclic", "static", "first-loading")
    assert case.working == () and np.isnan(case.rated_break_strength)


def test_more_tethers_than_a_bundle_has_are_refused(tmp_path):
    with pytest.raises(SettingsError, match="assembly.n_tethers.*less than or equal to 100"):
        load(tmp_path, '[assembly]\nn_tethers = 1000\n[assembly.curve]\nsource = "used"\n')


def test_tethers_that_are_alike_have_one_length_each(tmp_path):
    text = '[assembly]\nn_tethers = 3\nfree_length = "8 m"\n[assembly.curve]\nsource = "used"\n'
    assert load(tmp_path, text).free_lengths == (8.0, 8.0, 8.0)
