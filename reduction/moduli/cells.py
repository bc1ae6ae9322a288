"""Sums of samples by the cell they fall in, taken by several threads at a time.

References
----------
.. [1] T. A. Davis, "Direct Methods for Sparse Linear Systems," SIAM, 2006, ch. 2
   (compressed columns).
"""

from __future__ import annotations

import numpy as np
import scipy

from reduction.record import Integers


def sums_by_cell(cell: Integers, n_cells: int) -> scipy.sparse.csc_array:
    """Matrix that sums samples by cell: ``sums_by_cell(cell, n_cells) @ values``.

    Parameters
    ----------
    cell : ndarray of int, shape (n_samples,)
        Cell of each sample, from 0 and below ``n_cells``. [1]
    n_cells : int
        Number of cells. [1]

    Returns
    -------
    matrix : sparse array, shape (n_cells, n_samples)
        A one in each column. [1]

    Raises
    ------
    ValueError
        If there are more cells or samples than 32 bits count.

    Notes
    -----
    One column a sample, stored by columns ([1]_).  The sums are those of `numpy.bincount`,
    added in the same order, in about the same time; but bincount keeps the interpreter's
    lock, and blocks would wait for each other.

    Examples
    --------
    >>> sums_by_cell(np.array([0, 2, 2]), 3) @ np.array([1.0, 2.0, 3.0])
    array([1., 0., 5.])
    """
    if max(n_cells, cell.size) > np.iinfo(np.int32).max:
        raise ValueError(f"{cell.size} samples in {n_cells} cells are too many for one block")
    one_each = np.arange(cell.size + 1, dtype=np.int32)
    return scipy.sparse.csc_array(
        (np.ones(cell.size), cell.astype(np.int32), one_each), shape=(n_cells, cell.size)
    )
