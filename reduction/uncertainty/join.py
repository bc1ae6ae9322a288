"""Contributions to several quantities, or to several specimens, on one axis of components.

References
----------
.. [1] JCGM 100:2008, "Evaluation of measurement data - Guide to the expression of uncertainty in
   measurement," F.1.2.3 (correlation by common influence quantities).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reduction.record import Floats
from reduction.uncertainty.product import Component, Contributions


def merged(parts: Sequence[Contributions]) -> Contributions:
    """Contributions to different quantities, on the components of all of them.

    Parameters
    ----------
    parts : sequence of Contributions
        Each quantity in one of them; of one that stands in several, the last. [as quantity]

    Returns
    -------
    contributions : Contributions
        A component that a part does not know adds nothing to its quantities. [as quantity]

    Raises
    ------
    SettingsError
        If a component stands twice in a part.

    Notes
    -----
    Components that are equal are one error ([1]_).

    Examples
    --------
    >>> from reduction.uncertainty.product import Component
    >>> gain, zero = Component("tension_gain", "cell"), Component("tension_offset", "cell")
    >>> both = merged([Contributions((zero,), {"force": np.array([[2.0]])}),
    ...     Contributions((gain,), {"share": np.array([[0.01]])})])
    >>> print([one.source for one in both.component], both.values["force"].ravel())
    ['tension_gain', 'tension_offset'] [0. 2.]
    """
    component, place = _together(parts)
    values = {}
    for part in parts:
        rows = [place[one] for one in part.component]
        for name, array in part.values.items():
            table = np.zeros((len(component), *array.shape[1:]))
            table[rows] = array
            values[name] = table
    return Contributions(component, values)


def added(parts: Sequence[Contributions]) -> Contributions:
    """Contributions to a sum, of which each part adds some.

    Parameters
    ----------
    parts : sequence of Contributions
        To the same quantities, in the same shapes. [as quantity]

    Returns
    -------
    contributions : Contributions
        What the parts say of one component, added with their signs. [as quantity]

    Raises
    ------
    SettingsError
        If a component stands twice in a part.

    Notes
    -----
    Components that are equal are one error ([1]_).

    Examples
    --------
    >>> from reduction.uncertainty.product import Component
    >>> gain = (Component("tension_gain", "cell"),)
    >>> both = added([Contributions(gain, {"force": np.array([row])}) for row in (2.0, -0.5)])
    >>> print(both.values["force"])
    [1.5]
    """
    component, place = _together(parts)
    values: dict[str, Floats] = {}
    for part in parts:
        rows = [place[one] for one in part.component]
        for name, array in part.values.items():
            table = values.setdefault(name, np.zeros((len(component), *array.shape[1:])))
            table[rows] += array
    return Contributions(component, values)


def stacked(entries: Sequence[Contributions]) -> Contributions:
    """Contributions to the same quantities of several specimens, holds, ... along one axis.

    Parameters
    ----------
    entries : sequence of Contributions, length n_entries
        One a specimen; a quantity that one of them lacks is zero there. [as quantity]

    Returns
    -------
    contributions : Contributions
        Shape (n_components, n_entries, ...). [as quantity]

    Raises
    ------
    ValueError
        If a quantity has different shapes.

    Notes
    -----
    Components that are equal are one error ([1]_).

    Examples
    --------
    >>> from reduction.uncertainty.product import Component
    >>> new, used = (Contributions((Component("diameter", name),), {"area": np.array([size])})
    ...     for name, size in (("new", 2.0), ("used", 3.0)))
    >>> print(stacked([new, used]).values["area"])
    [[2. 0.]
     [0. 3.]]
    """
    component, place = _together(entries)
    shapes = {name: array.shape[1:] for part in entries for name, array in part.values.items()}
    values = {}
    rows = [[place[one] for one in part.component] for part in entries]
    for name, shape in shapes.items():
        table = np.zeros((len(component), len(entries), *shape))
        for index, part in enumerate(entries):
            if name in part.values:
                table[rows[index], index] = part.values[name]
        values[name] = table
    return Contributions(component, values)


def renamed(found: Contributions, names: dict[str, str]) -> Contributions:
    """Contributions under other names; a quantity without one is left out.

    Parameters
    ----------
    found : Contributions
        As computed. [as quantity]
    names : dict of str to str
        Name to new name.

    Returns
    -------
    contributions : Contributions
        [as quantity]

    Raises
    ------
    KeyError
        If a name is not there.

    Notes
    -----
    Nothing is computed ([1]_).

    Examples
    --------
    >>> from reduction.uncertainty.product import Component
    >>> cell = Contributions((Component("tension_gain", "cell"),), {"tension": np.array([1.0])})
    >>> print(list(renamed(cell, {"tension": "peak_tension"}).values))
    ['peak_tension']
    """
    return Contributions(found.component, {new: found.values[name] for name, new in names.items()})


def _together(
    parts: Sequence[Contributions],
) -> tuple[tuple[Component, ...], dict[Component, int]]:
    """Components of all parts, each once, and the row of each."""
    component = tuple(sorted({one for part in parts for one in part.component}))
    return component, {one: row for row, one in enumerate(component)}
