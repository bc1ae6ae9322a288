import numpy as np

from reduction.prediction.cord_curve import CordCurve, pieces_of

CORD = CordCurve(
    strain=np.array([0.0, 0.02, 0.06, 0.10, 0.15, 0.22]),
    load=np.array([0.0, 7.1, 22.2, 44.5, 80.1, 133.4]),
)


def test_pieces_are_slack_one_between_two_points_each_and_broken():
    pieces = pieces_of(CORD)
    assert pieces.coefficient.shape == (4, 7)
    assert np.all(pieces.coefficient[:, 0] == 0) and np.all(np.isnan(pieces.coefficient[:, -1]))
    assert pieces_of(CORD, order=1).coefficient.shape == (3, 7)
    assert pieces_of(CORD, order=-1).coefficient.shape == (5, 7)
