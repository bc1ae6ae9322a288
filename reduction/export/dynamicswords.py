"""What is said of the dynamics of an exported line: how they were found, what is doubtful."""

from __future__ import annotations

import math
from collections.abc import Mapping

from reduction.digits import plain_number
from reduction.export.dynamics import Viscoelasticity
from reduction.line.product import REASONS, LineParameters
from reduction.lookup.product import DesignValues
from reduction.record import Floats


def said_identified(
    part: Viscoelasticity, amplitude: float, half: Mapping[str, Floats], *, is_exact: bool
) -> str:
    """K_1 and tau, what they give back, and how well they are known.

    ``half`` are half widths of 95 % by name; ``is_exact`` where no interval of K_0 is known.
    """
    spring = part.fast_stiffness - part.static_stiffness
    return (
        f"K_1 {plain_number(spring)} N and tau {plain_number(part.relaxation_time, 4)} s "
        f"are identified from the surfaces "
        f"of K_ap and H and from K_0 at these levels: the exported line gives back K_ap "
        f"{plain_number(part.apparent_stiffness)} N and H "
        f"{plain_number(part.hysteresis_energy_at(part.frequency, amplitude), 4)} J/m there"
        + _said_known(half, is_exact=is_exact)
    )


def _said_known(half: Mapping[str, Floats], *, is_exact: bool) -> str:
    """How well K_1 and tau are known; what K_ap, H and K_0 share, they share here."""
    spring, time = (
        float(half[name]) for name in ("dissipation_spring_constant", "relaxation_time")
    )
    if not (math.isfinite(spring) and math.isfinite(time)):
        return "; K_ap or H has no interval, and so have K_1 and tau none"
    without = ", K_0 taken as exact: it has no interval" if is_exact else ""
    return (
        f"; 95 percent of K_1 +-{plain_number(spring, 3)} N, of tau "
        f"+-{plain_number(time, 3)} s{without}"
    )


def said_printed(
    rest: float,
    printed: Mapping[str, DesignValues],
    measured: Mapping[str, DesignValues],
    frequency: float,
    amplitude: float,
) -> str:
    """What the surfaces of K_1 and tau would have given; K_0 ``rest`` beside them."""
    if not printed:
        return "the source has no surfaces of K_1 and tau that can be used"
    spring, time = (float(one.value) for one in printed.values())
    said = (
        f"the printed surfaces of K_1 and tau, {plain_number(spring)} N and "
        f"{plain_number(time, 4)} s, are not used"
    )
    if not (spring > 0 and time > 0):
        return f"{said}: they are not above zero"
    part = Viscoelasticity(rest, rest + spring, spring * time, frequency=frequency)
    return f"{said}: they would give {_against(part, measured, amplitude)}"


def said_instead(
    part: Viscoelasticity, measured: Mapping[str, DesignValues], amplitude: float, reason: int
) -> str:
    """That the printed K_1 and tau stand, and how far off they are."""
    spring = part.fast_stiffness - part.static_stiffness
    return (
        f"DOUBTFUL: K_1 {plain_number(spring)} N and tau "
        f"{plain_number(part.relaxation_time, 4)} s are those of the "
        f"printed surfaces; none give back K_ap and H there: {REASONS[reason]}. They give "
        f"{_against(part, measured, amplitude)}"
    )


def _against(part: Viscoelasticity, measured: Mapping[str, DesignValues], amplitude: float) -> str:
    model = (part.apparent_stiffness, part.hysteresis_energy_at(part.frequency, amplitude))
    parts = []
    for value, (name, unit), found in zip(
        model, (("K_ap", "N"), ("H", "J/m")), measured.values(), strict=True
    ):
        own = float(found.value)
        share = f", {100 * (value / own - 1):+.1f} percent" if own > 0 else ""
        parts.append(
            f"{name} {plain_number(value)} {unit} where the line has {plain_number(own)}{share}"
        )
    return "; ".join(parts)


def doubts_of_identified(
    line: LineParameters, half_widths: Mapping[str, Floats], energy: DesignValues
) -> list[str]:
    """Intervals in which there is no damping at all, or that are not known."""
    said = []
    if not math.isfinite(float(energy.surface_low)):
        said.append("DOUBTFUL: how well the damping is known is not known: H has no interval")
    elif float(energy.surface_low) <= 0:
        said.append(
            "DOUBTFUL: the damping may be none: the 95 percent interval of H, "
            f"{interval_of(energy)}, holds zero"
        )
    half = float(half_widths["relaxation_time"])
    time = float(line.relaxation_time)
    if half >= time:
        said.append(
            f"DOUBTFUL: the dashpot is hardly known: tau {plain_number(time, 4)} s with a 95 "
            f"percent interval of +-{plain_number(half, 3)} s, from those of K_ap, H and K_0"
        )
    return said


def doubts_of_printed(time: DesignValues) -> list[str]:
    """The same of a tau that is a design value itself."""
    if not math.isfinite(float(time.surface_low)):
        return ["DOUBTFUL: how well the dashpot is known is not known: tau has no interval"]
    if float(time.surface_low) <= 0:
        return [
            "DOUBTFUL: the dashpot may be none: the 95 percent interval of tau, "
            f"{interval_of(time)}, holds zero"
        ]
    return []


def said_over_frequency(part: Viscoelasticity, frequencies: Floats, found: DesignValues) -> str:
    """K_ap of the exported line against the surface at several frequencies."""
    rows = []
    for row, frequency in enumerate(frequencies):
        model, own = part.apparent_stiffness_at(float(frequency)), float(found.value[row])
        inside = float(found.surface_low[row]) <= model <= float(found.surface_high[row])
        outside = "" if inside or math.isnan(found.surface_low[row]) else ", OUTSIDE its interval"
        share = f" ({100 * (model / own - 1):+.1f} percent{outside})" if own > 0 else ""
        rows.append(
            f"{plain_number(frequency, 3)} Hz {plain_number(model)} against "
            f"{plain_number(own)} N{share}"
        )
    return (
        "one K_1 and tau do not hold at every frequency; K_ap of the exported line against the "
        f"surface at this mean tension and amplitude: {', '.join(rows)}"
    )


def interval_of(found: DesignValues) -> str:
    """The 95 % interval of one surface, in words."""
    if not math.isfinite(float(found.surface_low)):
        return "an interval, which the source does not have"
    return (
        f"{plain_number(float(found.surface_low), 4)} to "
        f"{plain_number(float(found.surface_high), 4)} {found.unit}"
    )


def said_of_value(found: DesignValues) -> str:
    """Where one design value is from."""
    known = math.isfinite(float(found.surface_high))
    is_vague = known and float(found.surface_low) < 0
    return (
        f"{found.source}: {found.quantity} {plain_number(float(found.value), 6)} {found.unit}, "
        + (f"95 percent of the surface {interval_of(found)}" if known else "no interval known")
        + (": its lower end is below zero: not told from zero" if is_vague else "")
        + (f", errata {', '.join(found.errata)}" if found.errata else "")
        + ("" if found.is_inside else ", OUTSIDE what was tested")
        + (", untested corner" if found.is_untested else "")
    )
