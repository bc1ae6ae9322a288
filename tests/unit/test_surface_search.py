import numpy as np

from reduction.experiments.response_matrix import highest_of_each


def test_the_top_of_each_curve_is_found_between_places_of_the_grid():
    top = np.array([-1.234, 0.05, 1.9])
    place, height = highest_of_each(lambda x: 3 - (x - top) ** 2, np.linspace(-2, 2, 9), 3)
    np.testing.assert_allclose(place, top, atol=1e-7)
    np.testing.assert_allclose(height[1], 3 - (np.linspace(-2, 2, 9) - 0.05) ** 2)


def test_a_curve_that_only_rises_has_its_top_at_the_end_of_the_grid():
    place, _ = highest_of_each(lambda x: x, np.linspace(0, 1, 5), 1)
    np.testing.assert_allclose(place, [1.0], atol=1e-10)
