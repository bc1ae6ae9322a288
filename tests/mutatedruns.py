"""So many mutations of one strategy, each held against the invariant."""

import zlib
from collections import Counter

import hypothesis
from hypothesis import HealthCheck, Phase, given, settings
from invariant import InvariantError, judge
from mutations import strategies

__all__ = ["hold"]


def hold(name, n_examples, *, seed=0, broken=None):
    """Judge mutations of a strategy; the same ones for the same seed.

    Parameters
    ----------
    name : str
        Of the strategy.
    n_examples : int
        How many.
    seed : int
        Of the draws.
    broken : callable, optional
        Told of each mutation and error that breaks the invariant; the first is raised otherwise.

    Returns
    -------
    tally : Counter
        Of verdicts.
    """
    tally = Counter()

    @hypothesis.seed(seed + zlib.crc32(name.encode()))
    @settings(
        max_examples=n_examples, database=None, deadline=None, phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(strategies()[name])
    def each(mutation):
        try:
            tally[judge(mutation.case, mutation.files, mutation.expected)] += 1
        except InvariantError as error:
            if broken is None:
                raise InvariantError(f"{mutation!r} ({mutation.expected}): {error}") from error
            tally["broken"] += 1
            broken(mutation, error)

    each()
    return tally
