r"""How small an effect a screening will see, before a line is broken.

.. math:: E_{min} = t_{1 - \alpha/2;\, m}\, \frac{2 \sigma}{\sqrt{n}}

References
----------
.. [1] CG-D-39-80, Appendix A, Table A-2: the smallest significant effect at 90 %.
.. [2] R. L. Plackett and J. P. Burman, "The design of optimum multifactorial
   experiments," Biometrika 33(4), 1946.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import stdtrit

from reduction.checks import as_positive
from reduction.errors import SettingsError
from reduction.record import Floats
from reduction.surface.designs import Design


def smallest_effect(design: Design, *, sigma: ArrayLike, significance: float = 0.10) -> Floats:
    r"""Smallest effect that the screening is expected to call significant.

    .. math:: E_{min} = t_{1 - \alpha/2;\, m}\, \frac{2 \sigma}{\sqrt{n}}

    Parameters
    ----------
    design : Design
        Two levels; m is its number of dummy columns, or a third of its columns where there is
        none (Lenth), n its number of runs.
    sigma : array_like, shape (...)
        Standard deviation of one run; relative to the response where that is what is known.
        [unit of the response, or 1]
    significance : float
        Two-sided level; 0.10 is the 90 % of [1]_. [1]

    Returns
    -------
    smallest : ndarray, shape (...)
        [unit of sigma]

    Raises
    ------
    SettingsError
        If the level is not a share.
    DataError
        If sigma is not above zero.

    Notes
    -----
    An effect is the difference of two means of n / 2 runs [2]_.  The scatter that the dummies
    will show is taken as ``sigma`` itself; interactions, which they hold too, come on top.

    Examples
    --------
    Five factors in twelve runs, six dummies: 1.943 times 2 / sqrt(12).

    >>> from reduction.surface.designs import plackett_burman
    >>> print(smallest_effect(plackett_burman(5), sigma=1.0).round(3))
    1.122
    """
    if not 0 < significance < 1:
        raise SettingsError(
            "the level of significance is not a share",
            found=f"{significance:g}",
            needed="between 0 and 1",
        )
    freedom = design.dummy.shape[1] or design.n_factors / 3
    error = as_positive("sigma", sigma) * 2 / np.sqrt(design.n_runs)
    return np.asarray(stdtrit(freedom, 1 - significance / 2) * error)
