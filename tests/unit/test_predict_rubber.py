import numpy as np
import pytest
from scipy.integrate import quad

from reduction.prediction.rubber_wall import rubber_energy, rubber_stiffness, rubber_tension
from reduction.record.errors import DataError, SettingsError

STRETCH = np.array([1.001, 1.2, 1.7, 2.46, 3.5])
# written out once more, for a wall with A E = 1
LAWS = {
    "neo-hookean": lambda x: (x - 1 / x**2) / 3,
    "linear": lambda x: x - 1,
    "linear-current": lambda x: (x - 1) / x,
    "hencky": lambda x: np.log(x) / x,
}
EVERY_LAW = pytest.mark.parametrize("law", LAWS)


@EVERY_LAW
def test_the_tension_is_the_law(law):
    found = rubber_tension(STRETCH, area=2e-3, modulus=1.4e6, law=law)
    np.testing.assert_allclose(found, 2800 * LAWS[law](STRETCH), rtol=1e-12)


@EVERY_LAW
def test_a_wall_at_rest_bears_and_holds_nothing_and_has_its_modulus(law):
    wall = {"area": 2e-3, "modulus": 1.4e6, "law": law}
    assert rubber_tension(1.0, **wall) == 0
    assert rubber_energy(1.0, **wall) == 0
    np.testing.assert_allclose(rubber_stiffness(1.0, **wall), 2800, rtol=1e-15)


@EVERY_LAW
def test_the_energy_is_the_integral_of_the_law(law):
    areas = [quad(LAWS[law], 1, one, epsabs=0, epsrel=1e-12)[0] for one in STRETCH]
    found = rubber_energy(STRETCH, area=1.0, modulus=1.0, law=law)
    np.testing.assert_allclose(found, areas, rtol=1e-10)


@EVERY_LAW
def test_the_stiffness_is_the_slope_of_the_law(law):
    slope = (LAWS[law](STRETCH + 1e-6) - LAWS[law](STRETCH - 1e-6)) / 2e-6
    found = rubber_stiffness(STRETCH, area=1.0, modulus=1.0, law=law)
    np.testing.assert_allclose(found, slope, rtol=1e-7, atol=1e-9)


@EVERY_LAW
def test_compression_gives_a_negative_load(law):
    assert rubber_tension(0.9, area=1.0, modulus=1.0, law=law) < 0


def test_the_hencky_load_falls_beyond_e():
    wall = {"area": 1.0, "modulus": 1.0, "law": "hencky"}
    at_e, beyond = rubber_tension([np.e, 3.5], **wall)
    assert at_e > beyond and rubber_stiffness(3.5, **wall) < 0


@EVERY_LAW
@pytest.mark.parametrize("function", [rubber_tension, rubber_energy, rubber_stiffness])
def test_walls_and_stretches_broadcast(law, function):
    found = function(STRETCH, area=[[1.0], [2.0]], modulus=3.0, law=law)
    assert found.shape == (2, 5)
    np.testing.assert_allclose(found[1], 2 * found[0], rtol=1e-15)


@pytest.mark.parametrize("function", [rubber_tension, rubber_energy, rubber_stiffness])
def test_an_unknown_law_and_a_stretch_ratio_of_zero_are_refused(function):
    with pytest.raises(SettingsError, match="unknown law of rubber; found ogden; needed neo-hook"):
        function(1.5, area=1.0, modulus=1.0, law="ogden")
    with pytest.raises(DataError, match="stretch_ratio are not positive"):
        function([1.0, 0.0], area=1.0, modulus=1.0, law="linear")
