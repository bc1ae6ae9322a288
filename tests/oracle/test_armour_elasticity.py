"""A wire in a helix as a three-dimensional elastic body, against the rods of the package.

Displacements are those of a cable that is stretched and twisted as a whole, and a part that is the
same in every section of the wire seen in its own axes; that part is a polynomial over the section
with least energy.  The centre of the wire stays on its radius.  Small strains; no rod theory.
"""

from math import pi

import numpy as np
import pytest

from reduction.prediction.armour import ArmourDesign, _layer_stiffness, predict_armour

POISSON_RATIO, WIRE, DEGREE = 0.3, 1.0, 4
SLENDER = 40.0  # helix radius over wire radius
SECOND_ORDER = 6 / SLENDER**2  # what a rod leaves out


class Body:
    """Unit Young's modulus; axes are normal (inwards), binormal, tangent."""

    def __init__(self, degrees):
        angle = np.radians(degrees)
        self.sine, self.cosine = np.sin(angle), np.cos(angle)
        curvature, torsion = self.sine**2 / SLENDER, self.sine * self.cosine / SLENDER
        nodes, weights = np.polynomial.legendre.leggauss(8)
        turn = 2 * pi * np.arange(20) / 20
        radius, turn = np.meshgrid((nodes + 1) / 2, turn, indexing="ij")
        self.x, self.y = (radius * np.cos(turn)).ravel(), (radius * np.sin(turn)).ravel()
        self.area = (weights[:, None] / 2 * radius * 2 * pi / 20).ravel()
        metric = 1 - curvature * self.x
        self.volume = self.area * metric
        powers = [(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i)]
        value = np.array([self.x**i * self.y**j for i, j in powers])
        by_x = np.array([i * self.x ** max(i - 1, 0) * self.y**j for i, j in powers])
        by_y = np.array([j * self.x**i * self.y ** max(j - 1, 0) for i, j in powers])
        along = -torsion * (self.x * by_y - self.y * by_x) / metric
        n = len(powers)
        gradient = np.zeros((3, n, 3, 3, self.x.size))
        for k in range(3):
            gradient[k, :, k] = np.stack([by_x, by_y, along], axis=1)
        # the axes turn along the wire (Frenet)
        gradient[0, :, 1, 2] += torsion * value / metric
        gradient[0, :, 2, 2] -= curvature * value / metric
        gradient[1, :, 0, 2] -= torsion * value / metric
        gradient[2, :, 0, 2] += curvature * value / metric
        gradient = gradient.reshape(3 * n, 3, 3, -1)
        self.modes = (gradient + gradient.swapaxes(1, 2)) / 2
        mean = np.zeros((3, 3 * n))
        for k in range(3):
            mean[k, k * n : (k + 1) * n] = value @ self.area
        stiffness = np.einsum("aijq,bijq,q->ab", stress(self.modes), self.modes, self.volume)
        self.system = np.block([[stiffness, mean.T], [mean, np.zeros((3, 3))]])

    def strain(self, twisted):
        """Of the body for a unit strain, or a unit twist, of the cable."""
        axis = np.array([0.0, self.sine, self.cosine])
        if twisted:
            place = np.stack([self.x - SLENDER, self.y, 0 * self.x])
            whole = np.cross(axis, place.T).T[:, None] * axis[None, :, None]
        else:
            whole = np.outer(axis, axis)[:, :, None] * np.ones(self.x.size)
        whole = (whole + whole.swapaxes(0, 1)) / 2
        load = -np.einsum("ijq,bijq,q->b", stress(whole), self.modes, self.volume)
        solved = np.linalg.lstsq(self.system, np.append(load, np.zeros(3)), rcond=1e-13)[0]
        return whole + np.einsum("a,aijq->ijq", solved[: load.size], self.modes)


def stress(strain):
    shear = 1 / (2 * (1 + POISSON_RATIO))
    first = POISSON_RATIO / ((1 + POISSON_RATIO) * (1 - 2 * POISSON_RATIO))
    trace = np.trace(strain, axis1=-3, axis2=-2)[..., None, None, :]
    return first * trace * np.eye(3)[:, :, None] + 2 * shear * strain


def rod(degrees):
    return ArmourDesign(np.radians(degrees), WIRE, SLENDER - WIRE, 1.0, POISSON_RATIO)


@pytest.mark.parametrize("degrees", [10.0, 30.0, 45.0, 60.0, 80.0])
def test_conjugate_rod_agrees_with_the_elastic_body(degrees):
    body = Body(degrees)
    section = stress(body.strain(twisted=False))
    unit = 1e-9
    wire = predict_armour(rod(degrees), unit, theory="conjugate")
    axial = section[2, 2] @ body.area
    torsion = (body.x * section[1, 2] - body.y * section[0, 2]) @ body.area
    bending = -(body.x * section[2, 2]) @ body.area
    assert wire.axial_force[0] / unit == pytest.approx(axial, rel=SECOND_ORDER)
    assert wire.torsion_moment[0] / unit == pytest.approx(torsion, rel=SECOND_ORDER)
    # free thinning bends the wire by nu of what the strain does: 2 + nu in place of 2
    assert wire.bending_moment[0] / unit == pytest.approx(bending / 1.15, rel=SECOND_ORDER)


def test_elastic_body_has_torsion_at_45_degrees():
    body = Body(45.0)
    section = stress(body.strain(twisted=False))
    torsion = (body.x * section[1, 2] - body.y * section[0, 2]) @ body.area
    stiffness = rod(45.0).torsion_stiffness
    assert torsion == pytest.approx(stiffness / (4 * SLENDER), rel=SECOND_ORDER)


@pytest.mark.parametrize("degrees", [10.0, 45.0, 80.0])
def test_layer_stiffness_agrees_with_the_elastic_body(degrees):
    body = Body(degrees)
    stretched, twisted = body.strain(twisted=False), body.strain(twisted=True)

    def energy(one, other):
        return np.einsum("ijq,ijq,q->", stress(one), other, body.volume) / body.cosine

    layer = _layer_stiffness(rod(degrees))
    pairs = (
        (layer.tension_per_strain, energy(stretched, stretched)),
        (layer.torque_per_strain, energy(stretched, twisted)),
        (layer.torque_per_twist, energy(twisted, twisted)),
    )
    for computed, elastic in pairs:
        assert computed == pytest.approx(elastic, rel=SECOND_ORDER)
