"""Certified non-linear fits of NIST, to nine digits in parameters and standard deviations.

Source: NIST/ITL Statistical Reference Datasets, Nonlinear Regression (public domain).
The certified values are typed from the files; the data are read from them where present.
"""

import numpy as np
import pytest
from measured_logs import LOGS, needs_measured_logs

from reduction.stages.moduli.least_squares import fit_separable

DATA = LOGS / "nist-strd"
pytestmark = needs_measured_logs


def read(name):
    lines = (DATA / f"{name}.dat").read_text(encoding="ascii").splitlines()
    last = max(row for row, line in enumerate(lines) if line.startswith("Data:"))
    table = np.array([[float(cell) for cell in line.split()] for line in lines[last + 1 :] if line])
    return table[:, 1], table[:, 0]


def rise(x):
    """Basis of b1 (1 - exp(-b2 x)): BoxBOD and Misra1a."""
    return lambda rates: (
        1 - np.exp(-x[:, None] * rates[:, None, :]),
        x[:, None] * np.exp(-x[:, None] * rates[:, None, :]),
    )


@pytest.mark.parametrize("start", [[0.0001], [0.0005]])
def test_misra1a(start):
    x, y = read("Misra1a")
    fit = fit_separable(rise(x), y, starts=[start])
    found = [*fit.amplitude, *fit.shape]
    np.testing.assert_allclose(found, [2.3894212918e02, 5.5015643181e-04], rtol=1e-9)
    np.testing.assert_allclose(
        fit.standard_uncertainty, [2.7070075241e00, 7.2668688436e-06], rtol=1e-9
    )
    assert fit.residual_sum_of_squares == pytest.approx(1.2455138894e-01, rel=1e-9)


@pytest.mark.parametrize("start", [[1.0], [0.75]])
def test_boxbod(start):
    x, y = read("BoxBOD")
    fit = fit_separable(rise(x), y, starts=[start])
    found = [*fit.amplitude, *fit.shape]
    np.testing.assert_allclose(found, [2.1380940889e02, 5.4723748542e-01], rtol=1e-9)
    np.testing.assert_allclose(
        fit.standard_uncertainty, [1.2354515176e01, 1.0455993237e-01], rtol=1e-9
    )
    assert fit.residual_sum_of_squares == pytest.approx(1.1680088766e03, rel=1e-9)


def test_mgh17_two_exponentials_and_a_constant():
    x, y = read("MGH17")
    grid = np.geomspace(1 / 640, 1 / 10, 6)

    def basis(rates):
        decay = np.exp(-x[:, None] * rates[:, None, :])
        level = np.ones((len(rates), x.size, 1))
        return np.concatenate([level, decay], axis=2), -x[:, None] * decay

    fit = fit_separable(
        basis,
        y,
        starts=[(low, high) for low in grid for high in grid if low < high],
    )
    slow_first = np.argsort(fit.shape)  # the two terms may change places
    order = np.r_[0, 1 + slow_first, 3 + slow_first]
    found = np.r_[fit.amplitude, fit.shape][order]
    certified = [
        3.7541005211e-01,
        1.9358469127e00,
        -1.4646871366e00,
        1.2867534640e-02,
        2.2122699662e-02,
    ]
    np.testing.assert_allclose(found, certified, rtol=1e-9)
    certified = [
        2.0723153551e-03,
        2.2031669222e-01,
        2.2175707739e-01,
        4.4861358114e-04,
        8.9471996575e-04,
    ]
    np.testing.assert_allclose(fit.standard_uncertainty[order], certified, rtol=1e-9)
    assert fit.residual_sum_of_squares == pytest.approx(5.4648946975e-05, rel=1e-8)
