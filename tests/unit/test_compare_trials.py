import numpy as np
import pytest
from measured_hoses import Truth

from reduction.prediction.hose_comparison import _design_with, _number_of


def test_a_layer_diameter_moves_both_layers():
    design = Truth().design()
    assert _number_of(design, "layer_diameter") == pytest.approx(3.5 * 0.0254)
    moved = _design_with(design, {"layer_diameter": 3.6 * 0.0254}).layer_diameter
    assert np.array(moved) == pytest.approx(np.array([3.5, 3.7]) * 0.0254)
