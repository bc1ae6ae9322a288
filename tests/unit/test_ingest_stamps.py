import numpy as np

from reduction.readers.sample_flags import _bridge_stamps


def bridged(time):
    time = np.array(time, float)
    return _bridge_stamps(time, np.isnan(time)).tolist()


def test_stamps_between_and_beyond_those_that_are_there_go_on_evenly():
    assert bridged([np.nan, 2, np.nan, np.nan, 8, 10, np.nan]) == [0, 2, 4, 6, 8, 10, 12]


def test_one_stamp_alone_tells_no_step():
    assert bridged([np.nan, 2, np.nan]) == [2, 2, 2]


def test_a_time_that_is_whole_is_handed_back():
    time = np.arange(3.0)
    assert _bridge_stamps(time, np.zeros(3, dtype=bool)) is time
