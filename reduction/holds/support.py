"""One specimen in one hold, and everything that speaks against a number from it.

References
----------
.. [1] J. D. Irish, W. Paul and D. M. Wyman, "The Determination of the Elastic Modulus of
   Rubber Mooring Tethers and their Use in Coastal Moorings," Woods Hole Oceanog. Inst.,
   Woods Hole, MA, Tech. Rep. WHOI-2005-10, Dec. 2005.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from reduction.holds.ramp import Ramp
from reduction.holds.relaxation import end_mean, relaxation_drop
from reduction.moduli.steps import find_steps
from reduction.record import Floats
from reduction.samples.blocks import BLOCK, sample_blocks
from reduction.samples.columns import chosen, median_step_reaches, shifted
from reduction.settings import HoldSettings

SIGNIFICANT = 3.0
FEWEST_SAMPLES = 20
FINAL_SHARE = 0.05
INITIAL_SHARE = 0.005
STEP_BLOCKS = 4096
STEP_FALSE_ALARM = 1e-3


@dataclass(frozen=True)
class Hold:
    """One specimen in one hold: finite samples in order, and the ramp before them.

    Parameters
    ----------
    time, position, tension, strain : ndarray, shape (n_samples,)
        Samples of the hold. [s], [m], [N], [1]
    start_time : float
        First time of the standstill. [s]
    ramp : Ramp or None
        None where the record does not show it.
    position_tolerance : float
        Range of position that was allowed inside the standstill. [m]
    slack_tension : float
        Tension at or below which the specimen is slack. [N]
    refusals, notes : list of str
        Filled as the hold is reduced.
    """

    time: Floats
    position: Floats
    tension: Floats
    strain: Floats
    start_time: float
    ramp: Ramp | None
    position_tolerance: float
    slack_tension: float = 0.0
    refusals: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def duration(self) -> float:
        """From the first to the last sample. [s]."""
        return float(self.time[-1] - self.time[0]) if self.time.size else 0.0

    @property
    def strain_uncertainty(self) -> float:
        """Of its mean strain (type A); NaN with fewer than two readings. [1]."""
        (known,) = chosen(lambda part: np.isfinite(self.strain[part]), self.strain)
        if known.size < 2:
            return float("nan")
        return end_mean(known, n_samples=known.size, at_end=True)[1]

    @property
    def since_centre(self) -> Floats:
        """Time from the centre of the ramp, or from the first sample where none is known. [s]."""
        centre = self.time[0] if self.ramp is None else self.ramp.centre_time
        return shifted(self.time, float(centre))

    @property
    def ramp_duration(self) -> float:
        """Of the equivalent constant-rate ramp; 0 where none is known. [s]."""
        return 0.0 if self.ramp is None else self.ramp.duration


@dataclass(frozen=True)
class Ends:
    """Tension at both ends of a hold, and the share lost.

    Parameters
    ----------
    initial, final : float
        Means of short stretches. [N]
    drop, drop_uncertainty : float
        Share lost and its standard uncertainty (type A). [1]
    initial_uncertainty, final_uncertainty : float
        Of the two means (type A). [N]
    """

    initial: float
    final: float
    drop: float
    drop_uncertainty: float
    initial_uncertainty: float
    final_uncertainty: float


def hold_ends(hold: Hold) -> Ends:
    """Tension at both ends of a hold; the stretches are named in its notes.

    Parameters
    ----------
    hold : Hold
        Three samples or more.

    Returns
    -------
    ends : Ends
        Means and drop.

    Raises
    ------
    DataError
        If there are fewer than two samples.

    Notes
    -----
    The first stretch is a tenth of the ramp time, at least 0.5 % of the hold and three
    samples; the last is 5 % of the samples, at least three.

    Examples
    --------
    WHOI-2005-10, sec. 4.1: 400 lbf falls to 325 lbf in three minutes.

    >>> t = np.linspace(0, 180, 361)
    >>> load = np.where(t < 2, 400.0, 325.0)
    >>> hold = Hold(t, 0 * t, load, 2.75 + 0 * t, 0.0, None, 0.01)
    >>> round(hold_ends(hold).drop, 4)
    0.1875
    """
    step = hold.duration / max(1, hold.time.size - 1)
    stretch = max(INITIAL_SHARE * hold.duration, 0.1 * hold.ramp_duration)
    n_initial = max(3, int(stretch / step)) if step > 0 else 3
    n_final = max(3, int(FINAL_SHARE * hold.time.size))
    initial, u_initial = end_mean(hold.tension, n_samples=n_initial, at_end=False)
    final, u_final = end_mean(hold.tension, n_samples=n_final, at_end=True)
    hold.notes.append(
        f"initial tension is the mean of the first {n_initial}, final tension of the last "
        f"{n_final} of {hold.time.size} samples"
    )
    drop = float(relaxation_drop(initial, final))
    uncertainty = float(np.hypot(u_final, (1 - drop) * u_initial) / initial)
    known = uncertainty if drop == drop else np.nan
    return Ends(initial, final, drop, known, u_initial, u_final)


def _step_reason(hold: Hold) -> str | None:
    """Name a step of tension inside the hold, where there is one."""
    if hold.time.size < FEWEST_SAMPLES or not median_step_reaches(
        hold.time, 3, _longest_step(hold.time)
    ):
        return None
    size = -(-hold.time.size // STEP_BLOCKS)
    whole = hold.time.size // size * size
    if whole < 24 * size:
        return None
    parts = sample_blocks(whole, hold.tension, size=size * max(1, BLOCK // size))
    series = np.concatenate([hold.tension[part].reshape(-1, size).mean(axis=1) for part in parts])
    steps = find_steps(series, false_alarm=STEP_FALSE_ALARM)
    if not steps:
        return None
    largest = max(steps, key=lambda step: abs(step.size))
    when = hold.time[largest.onset * size] - hold.start_time
    return (
        f"tension steps by {largest.size:.3g} N at {when:.0f} s into the hold, which "
        "relaxation does not explain (a slip of the splice?)"
    )


def _longest_step(time: Floats) -> float:
    return max(
        float(np.diff(time[part]).max(initial=0.0))
        for part in sample_blocks(time.size, time, overlap=1)
    )


def _motion_reason(hold: Hold, ends: Ends) -> str | None:
    """Name a motion of the crosshead that is worth more than a tenth of the drop."""
    n_samples = max(3, int(FINAL_SHARE * hold.time.size))
    before, u_before = end_mean(hold.position, n_samples=n_samples, at_end=False)
    after, u_after = end_mean(hold.position, n_samples=n_samples, at_end=True)
    motion, noise = after - before, float(np.hypot(u_before, u_after))
    if hold.ramp is None or not np.isfinite(hold.ramp.stiffness):
        moved = abs(motion) > max(SIGNIFICANT * noise, 0.5 * hold.position_tolerance)
        worth = ""
    else:
        stiffness = abs(hold.ramp.stiffness)
        lost = abs(ends.initial - ends.final)
        moved = abs(motion) > SIGNIFICANT * noise and stiffness * abs(motion) > max(
            0.1 * lost, SIGNIFICANT * ends.drop_uncertainty * ends.initial
        )
        worth = f", worth {stiffness * abs(motion):.3g} N"
    return f"the crosshead moves by {motion:.2g} m in the hold{worth}" if moved else None


def reasons_against(hold: Hold, ends: Ends, settings: HoldSettings) -> list[str]:
    """Everything that speaks against relaxation numbers from a hold.

    Parameters
    ----------
    hold : Hold
        The samples.
    ends : Ends
        From `hold_ends`.
    settings : HoldSettings
        Shortest duration.

    Returns
    -------
    reasons : list of str
        Empty where nothing speaks against it.

    Raises
    ------
    DataError
        If the samples hold a value that is not finite.

    Notes
    -----
    Too short; too few samples; a slack specimen; tension that rises by more than three standard
    uncertainties; a crosshead that moves by more than three standard uncertainties where
    the motion is worth more than a tenth of the drop (by the stiffness of the ramp); a
    step of tension that relaxation does not explain (`find_steps`, false alarm 0.1 %).

    Examples
    --------
    >>> t = np.linspace(0, 10, 101)
    >>> hold = Hold(t, 0 * t, 400 - t, 1 + 0 * t, 0.0, None, 0.01)
    >>> reasons_against(hold, hold_ends(hold), HoldSettings())
    ['the hold is too short: 10 s; 30 s or more are needed']
    """
    reasons = []
    if hold.duration < settings.minimum_duration:
        reasons.append(
            f"the hold is too short: {hold.duration:.3g} s; "
            f"{settings.minimum_duration:g} s or more are needed"
        )
    if hold.time.size < FEWEST_SAMPLES:
        reasons.append(f"too few samples: {hold.time.size}; {FEWEST_SAMPLES} are needed")
    if not ends.final > hold.slack_tension or not ends.drop_uncertainty < 1 / SIGNIFICANT:
        reasons.append(
            f"the specimen is slack: {ends.final:.3g} N; more than "
            f"{hold.slack_tension:.3g} N is needed"
        )
    elif ends.drop < -SIGNIFICANT * ends.drop_uncertainty:
        reasons.append(
            f"tension rises by {-ends.drop:.2%} over the hold (recovery after unloading, or drift)"
        )
    reasons += [reason for reason in (_motion_reason(hold, ends), _step_reason(hold)) if reason]
    return reasons
