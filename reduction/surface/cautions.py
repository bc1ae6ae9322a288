r"""What is wrong with a run sheet before a line is broken on it.

References
----------
.. [1] CG-D-39-80: sec. 4.3 (order of the runs), sec. 3.4 (snap loading is cyclic loading
   with a minimum of zero; nylon failed by it above 30 % of the break strength), App. A
   (levels chosen to keep a minimum tension of 3 %).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reduction.errors import SettingsError
from reduction.record import Bools, Floats
from reduction.surface.runsheet import RunSheet

CautionKind = Literal[
    "load-not-known",
    "slack",
    "load-over-limit",
    "share-over-limit",
    "share-not-known",
    "no-repeats",
    "pure-error-excludes-drift",
    "order-confounded",
]

NEAR_ZERO = 1e-9  # of the peak: 12 % less 12 % is zero though its last bit may not be
MEASURED_SLACK = 0.01  # of the peak, as in reduction.line.loops
CONFOUNDED = 0.5


@dataclass(frozen=True)
class Caution:
    """One thing to know before the runs are run.

    Parameters
    ----------
    kind : str
        A fixed name, for scripts.
    message : str
        What is so, with its numbers.
    hint : str
        What can be done.
    runs : tuple of int
        Numbers of the runs it is about, in the order of the sheet; empty: the sheet.
    """

    kind: CautionKind
    message: str
    hint: str
    runs: tuple[int, ...] = ()


def _numbers(sheet: RunSheet, chosen: Bools) -> tuple[int, ...]:
    return tuple(int(number) for number in sheet.run[chosen])


def _named(runs: tuple[int, ...], names: Mapping[int, str]) -> str:
    listed = ", ".join(names[run] for run in runs)
    return f"run {listed}" if len(runs) == 1 else f"runs {listed}"


def _slack(sheet: RunSheet, names: Mapping[int, str], *, is_measured: bool) -> list[Caution]:
    share_of_peak = MEASURED_SLACK if is_measured else NEAR_ZERO
    chosen = sheet.minimum_tension <= share_of_peak * sheet.peak_tension
    runs = _numbers(sheet, chosen)
    if not runs:
        return []
    least = float(np.min(sheet.minimum_tension[chosen]))
    rounding = NEAR_ZERO * float(np.max(sheet.peak_tension))
    if least < -rounding:
        goes = f"falls below zero, to {least:.4g} N"
    elif least <= rounding:
        goes = "reaches zero"
    else:
        goes = f"falls to {least:.4g} N, which is no tension to a load cell"
    when = "" if is_measured else " in every cycle"
    highest = float(np.max(sheet.peak_share[chosen]))
    share = (
        f"; its peak is {100 * highest:.4g} % of the break strength, and nylon failed by such "
        "cycles above 30 %"
        if np.isfinite(highest)
        else ""
    )
    return [
        Caution(
            "slack",
            f"the minimum tension of {_named(runs, names)} {goes}: the line goes slack{when} "
            f"and snaps taut{share}",
            "Give the amplitude as a fraction of the mean tension, or raise the lowest mean.",
            runs,
        )
    ]


def _over(
    sheet: RunSheet,
    names: Mapping[int, str],
    load_limit: float | None,
    peak_share_limit: float | None,
) -> list[Caution]:
    found = []
    if load_limit is not None:
        runs = _numbers(sheet, sheet.peak_tension > load_limit * (1 + NEAR_ZERO))
        if runs:
            found.append(
                Caution(
                    "load-over-limit",
                    f"the peak tension of {_named(runs, names)} is above the limit of "
                    f"{load_limit:.4g} N, up to {float(np.max(sheet.peak_tension)):.4g} N",
                    "Lower the levels, or take a machine and a cell for the load.",
                    runs,
                )
            )
    if peak_share_limit is not None:
        runs = _numbers(sheet, sheet.peak_share > peak_share_limit * (1 + NEAR_ZERO))
        if runs:
            found.append(
                Caution(
                    "share-over-limit",
                    f"the peak tension of {_named(runs, names)} is above "
                    f"{100 * peak_share_limit:.4g} % of the rated break strength, up to "
                    f"{100 * float(np.max(sheet.peak_share)):.4g} %",
                    "Lower the levels: the line may creep, heat or break in these runs.",
                    runs,
                )
            )
        elif np.isnan(sheet.peak_share).any():
            found.append(
                Caution(
                    "share-not-known",
                    "the peak tension as a share of the break strength is not known",
                    "Give rated_break_strength of the specimen.",
                )
            )
    return found


def _repeats(sheet: RunSheet, names: Mapping[int, str]) -> list[Caution]:
    _, group, count = np.unique(sheet.coded, axis=0, return_inverse=True, return_counts=True)
    group = group.ravel()
    if count.max() == 1:
        return [
            Caution(
                "no-repeats",
                "no run is repeated: there is no pure error and no test of lack of fit",
                "Add centre runs.",
            )
        ]
    found = []
    for number in np.flatnonzero(count > 1):
        place = np.flatnonzero(group == number)
        if np.all(np.diff(place) == 1):
            runs = _numbers(sheet, group == number)
            found.append(
                Caution(
                    "pure-error-excludes-drift",
                    f"{_named(runs, names)} are one run repeated without another between: their "
                    "scatter leaves out what the line goes through over the test, and the test "
                    "of lack of fit is too sharp",
                    "Spread the repeats over the order (repeats = spread).",
                    runs,
                )
            )
    return found


def _order(sheet: RunSheet) -> list[Caution]:
    place = np.arange(sheet.n_runs) - (sheet.n_runs - 1) / 2
    levels = sheet.coded - sheet.coded.mean(axis=0)
    size = np.linalg.norm(levels, axis=0) * np.linalg.norm(place)
    correlation: Floats = np.divide(place @ levels, size, out=np.zeros_like(size), where=size > 0)
    strong = np.flatnonzero(np.abs(correlation) > CONFOUNDED)
    if not strong.size:
        return []
    listed = ", ".join(f"{sheet.names[i]} {correlation[i]:+.2f}" for i in strong)
    return [
        Caution(
            "order-confounded",
            f"a factor follows the order of the runs (correlation {listed}): wear, heating and "
            "bedding-in over the test look like its effect",
            "Break the line in above the highest peak first, or run a second line in another "
            "order.",
        )
    ]


def find_cautions(
    sheet: RunSheet,
    *,
    load_limit: float | None = None,
    peak_share_limit: float | None = None,
    run_names: Sequence[str] | None = None,
    is_measured: bool = False,
) -> tuple[Caution, ...]:
    """What to know of a run sheet before the first run.

    Parameters
    ----------
    sheet : RunSheet
        From `make_run_sheet`.
    load_limit : float, optional
        Greatest tension that machine, cell or laboratory allow; None: not looked at. [N]
    peak_share_limit : float, optional
        Greatest peak as a share of the rated break strength; None: not looked at. [1]
    run_names : sequence of str, length n_runs, optional
        What the messages call the runs of the sheet; None: their numbers.
    is_measured : bool
        The tensions were measured, where a slack line reads up to 1 % of its peak.

    Returns
    -------
    cautions : tuple of Caution
        Slack runs, loads above a limit, repeats that show no drift, order confounded
        with a factor; empty where there is nothing to say.

    Raises
    ------
    SettingsError
        If a limit is not above zero, or the names do not fit the runs.

    Notes
    -----
    The run with the lowest mean and the highest amplitude reaches zero tension on every
    line of [1]_ (12 less 12, 10 less 10 % of the break strength): the condition that
    [1]_ itself calls snap loading.  The three centre runs of [1]_ are
    consecutive, and its order rises with the load.

    Examples
    --------
    >>> from reduction.surface.designs import box_behnken
    >>> from reduction.surface.levels import FactorLevels
    >>> from reduction.surface.runsheet import make_run_sheet
    >>> levels = (
    ...     FactorLevels("frequency", 0.1, 0.5),
    ...     FactorLevels("mean_tension", 0.12, 0.30, "rated_break_strength"),
    ...     FactorLevels("tension_amplitude", 0.05, 0.12, "rated_break_strength"),
    ... )
    >>> sheet = make_run_sheet(box_behnken(3), levels, rated_break_strength=28.5e3)
    >>> [(caution.kind, caution.runs) for caution in find_cautions(sheet)][:2]
    [('slack', (11,)), ('pure-error-excludes-drift', (13, 14, 15))]
    """
    for name, limit in (("load_limit", load_limit), ("peak_share_limit", peak_share_limit)):
        if limit is not None and not limit > 0:
            raise SettingsError(
                f"{name} is not above zero", found=f"{limit:g}", needed="a limit above zero"
            )
    labels = tuple(str(run) for run in sheet.run) if run_names is None else tuple(run_names)
    if len(labels) != sheet.n_runs:
        raise SettingsError(
            "the names do not fit the runs", found=str(len(labels)), needed=str(sheet.n_runs)
        )
    names = dict(zip(sheet.run.tolist(), labels, strict=True))
    if np.isnan(sheet.peak_tension).any():
        loads = [
            Caution(
                "load-not-known",
                "mean tension and tension amplitude are not both factors: peak and minimum "
                "tension are not known, and the runs stand in the standard order",
                "Add the factor, or check the loads of each run by hand.",
            )
        ]
    else:
        loads = _slack(sheet, names, is_measured=is_measured)
        loads += _over(sheet, names, load_limit, peak_share_limit)
    return tuple(loads + _repeats(sheet, names) + _order(sheet))
