"""What each note says: its severity and the sentence for a reader, by code.

A sentence is a format of the numbers of the note; where it needs more than a format, a function of
them.  A code never gets another meaning.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import degrees
from typing import Literal

Severity = Literal["warning", "refusal", "note"]


def _plural(number: int) -> str:
    return "" if number == 1 else "s"


def _rests(number: int) -> str:
    return f"{number} rest{_plural(number)}"


def _against(change: float, more: str, less: str) -> str:
    """A change in percent without its sign, and which way it goes."""
    return f"{100 * abs(change):.1f} % {more if change > 0 else less}"


def _pascals(value: float) -> str:
    """A stress in MPa or GPa."""
    return f"{value / 1e9:.3g} GPa" if abs(value) >= 1e9 else f"{value / 1e6:.3g} MPa"


def _one(of: str) -> str:
    """A kind with its article."""
    return f"{'an' if of[0] in 'aeiou' else 'a'} {of}"


def _would_fit(readings: str) -> str:
    """Readings by which a number would lie in its band, as a sentence of its own."""
    return f" Inside it with: {readings}" if readings else ""


def _is_like(like: str) -> str:
    """What a ratio is like, in brackets."""
    return f" (as {like})" if like else ""


def _left_out(n_cycles: int) -> str:
    """How many cycles lie between levels, as a part of a sentence."""
    return f" ({n_cycles} cycle{_plural(n_cycles)} between them in none)" if n_cycles else ""


def _unknown_mass(mass: float, usual: float, effect: float, cell: str) -> str:
    """What a mass that nobody stated would do."""
    lacks = (
        "the mass between specimen and moving load cell is not stated"
        if cell
        else "at which end the load cell is, and the mass beside it, are not stated"
    )
    return (
        f"{lacks}: {mass:.3g} kg at a moving load cell would move K_ap by its standard uncertainty,"
        f" {usual:g} kg (a grip for 22 kN) by {effect:+.2%}; on the fixed frame none is felt. State"
        " load_cell_at and attached_mass in the layout"
    )


def _unknown_compliance(compliance: float, usual: float, effect: float) -> str:
    """What give that nobody stated would do."""
    return (
        f"the compliance of frame, load cell and grips is not stated: {compliance:.3g} m/N would"
        f" move K_ap by its standard uncertainty, {usual:.2g} m/N (a frame for 100 kN, without"
        f" grips) by {effect:+.2%}. State machine_compliance in the layout"
    )


_OF_READING: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "laboratory": ("note", "{text}"),
    "misprint-corrected": (
        "note", "length at {reading} is {length}, printed {printed} ({erratum})",
    ),
    "counter-missing": (
        "note", "the cycle counter is missing on {n_rows} rows, -1 there",
    ),
    "resampled": (
        "note",
        "{channels}: {rate:.4g} Hz resampled to the {base_rate:.4g} Hz of {base} by linear"
        " interpolation",
    ),
    "channels-not-used": ("note", "read, but not part of a record: {channels}"),
    "record-of-pieces": ("note", "one record of {n_pieces} pieces: {files}"),
    "reference-length-elsewhere": (
        "warning",
        "reference_length is stated at {stated:.4g} N, but where displacement is first zero the"
        " tension of {specimen} is {found:.4g} N",
    ),
    "rows-without-time": (
        "warning",
        "{n_rows} rows have no time, first sample {sample}: their time is that of even steps"
        " between the rows beside them, and their position is not used",
    ),
    "sampling-uneven": (
        "note",
        "the sampling rate is not constant: {n_uneven} of {n_steps} time steps differ by more than"
        " {tolerance:.0%} from their median {median:.4g} s ({shortest:.4g} to {longest:.4g} s, gaps"
        " apart)",
    ),
    "channel-steps": (
        "note",
        lambda channel, low, high, unit, sample, time, n_more, beside: (
            f"{channel} steps from {low:.4g} to {high:.4g} {unit} between sample {sample}"
            f" ({time:.6g} s) and the next{f', and at {n_more} more' if n_more else ''}, and stays"
            f" there, while {beside} not: a slip, a break, a zero that was set again, or another"
            " unit from there on; numbers across it mix both"
        ),
    ),
    "rows-flagged": (
        "warning", "{n_read} rows read, {n_kept} kept, flagged: {flags}",
    ),
    "rows-set-aside": (
        "note", "{n_read} rows read, {n_kept} kept, flagged: {flags}",
    ),
    "rows-resampled": (
        "note", "{n_read} rows read, {n_kept} kept, flagged: {flags}",
    ),
    "lines-not-kept": ("note", "{n_lines} more lines that are not data are not kept"),
    "blocks-read": ("note", "{n_blocks} blocks of data"),
    "lines-between-blocks-not-kept": (
        "note", "{n_lines} more lines between the blocks are not kept",
    ),
    "blocks-not-read": (
        "note",
        "{n_blocks} blocks of another kind with {n_rows} rows are not read, the first at row {row}",
    ),
    "metadata-left-out": (
        "note", "{key!r} of the file is left out: it has {n_characters:,} characters",
    ),
    "blank-rows": ("note", "{n_rows} blank rows at the end of the sheet are left out"),
    "log-cut-off": (
        "note", "the file ends inside a block of data: the logger was stopped or cut off",
    ),
    "levels-found": (
        "warning",
        lambda n_levels, steps, n_left_out: (
            f"the log holds {n_levels} levels and states no steps: each was found in the record and"
            f" is reduced by itself{_left_out(n_left_out)}; to keep or change them, paste into the"
            f" table of the test in campaign.toml: {steps}"
        ),
    ),
    "cycles-unlike": (
        "warning",
        lambda mean, ratio, steps: (
            f"the cycles are unlike (nine tenths of their means lie {100 * mean:.0f} % of a range"
            f" apart, their ranges a factor of {ratio:.2f}): a mean of the test is of none of them"
            + (f"; its levels are {steps}" if steps else "")
        ),
    ),
    "held-load-repeats": (
        "note",
        "{n_samples} samples in holds at constant tension repeat one value of it: their flags stuck"
        " and saturated are taken off, since the machine holds it there",
    ),
}  # fmt: skip

_OF_STRAIN: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "marks-count-as-exact": (
        "note",
        lambda rows="rows": (
            f"the {rows} have no stated reading error and none to spare: they count as exact"
        ),
    ),
    "marks-error-from-scatter": (
        "note",
        lambda freedom, rows="rows": (
            f"the {rows} have no stated reading error: their scatter is taken, with {freedom}"
            f" degree{_plural(freedom)} of freedom"
        ),
    ),
    "marks-scatter": (
        "note",
        lambda ratio, chi_square, freedom, chance, rows="rows": (
            f"the {rows} scatter {ratio:.1f} times as much as the tape explains (chi-square"
            f" {chi_square:.3g} of {freedom} degree{_plural(freedom)} of freedom, one in"
            f" {f'{1 / chance:,.0f}' if chance > 1e-6 else 'a million or more'}); their uncertainty"
            " is widened by as much"
        ),
    ),
    "constant-fraction-off": (
        "warning",
        lambda low, high, effect: (
            f"constant-fraction misses its own marks by {100 * low:+.1f} to {100 * high:+.1f}"
            f" points of strain and reads moduli over them {_against(effect, 'high', 'low')}"
        ),
    ),
    "marks-differ": (
        "warning",
        lambda method, rms, expected: (
            f"strain by {method} differs from the marks by {100 * rms:.2f} points rms, tape reading"
            f" alone explains {100 * expected:.2f}"
        ),
    ),
    "marks-outlier": (
        "warning",
        lambda test, hold, residual: (
            f"the mark of test {test}, hold {hold}, lies {100 * residual:+.1f} points off the fit;"
            " its tape readings want a second look"
        ),
    ),
    "slack-length-grows": (
        "warning",
        lambda growth, effect: (
            f"the slack length grows by {1e3 * growth:.0f} mm ({100 * effect:.1f} %) from the first"
            " test to the last (permanent set, or a splice let out); strain counts from the mean"
            " slack length"
        ),
    ),
    "marks-of-failed-tests": (
        "note",
        "{n_marks} of {n_stretched} stretched marks are of tests that failed ({tests}), so that"
        " their tension is not known; the law of tension is without them",
    ),
    "marks-without-hold": (
        "note",
        "{n_marks} of {n_stretched} stretched marks have no hold in the logs and are left out",
    ),
    "load-zero-wrong": (
        "warning",
        lambda load, n_rests, zero, effect: (
            f"the load cell reads {load:.4g} N where the specimen is slack ({_rests(n_rests)}),"
            f" {100 * abs(effect):.2g} % of the greatest load, and load rises with stretch: its"
            f" zero is wrong{', not its sign' if load < 0 else ''}; "
            + (
                f'set zero = "{zero}" for this channel'
                if zero
                else "set zero of this channel in each layout of the log"
            )
        ),
    ),
    "load-zero-off": (
        "note",
        lambda load, n_rests, zero: (
            f"the load cell reads {load:.4g} N where the specimen is slack ({_rests(n_rests)}),"
            " beyond its noise"
            + (f'; zero = "{zero}" for this channel takes it off' if zero else "")
        ),
    ),
    "load-negative": (
        "warning",
        "load is negative ({load:.4g} N in the middle, {least:.4g} N at the least) and rises with"
        " stretch: the zero of the load cell is wrong, not its sign; the log has no rest at slack,"
        " so set zero of this channel to what the cell read without load",
    ),
    "load-falls-with-stretch": (
        "warning",
        "load is negative ({load:.4g} N in the middle) and falls with stretch; does the log count"
        " compression positive? Then set sign = -1 for this channel",
    ),
    "strain-below-zero": (
        "warning",
        lambda least, tension, reference, rises: (
            f"strain is down to {100 * least:.3g} % at tensions up to {tension:.3g} N, above the"
            f" {reference:.3g} N at which it should be zero: "
            + (
                "the zero of crosshead_position is not where the specimen has that tension"
                if rises
                else "tension rises where crosshead_position falls; does it count the other way?"
                " Then set sign = -1 for it"
            )
        ),
    ),
    "strain-from-tension": (
        "note",
        "strain is zero at the reference tension of {tension:.4g} N, at which its gauge length was"
        " stated",
    ),
    "reference-tension-elsewhere": (
        "warning",
        "the layout has the reference tension of {tension:.4g} N at {stated:.4g} m, the log first"
        " at {found:.4g} m; strain is zero at the latter",
    ),
    "gauge-length-from-reference": (
        "warning",
        "no gauge_length is stated: strain refers to all of the reference_length, {length:.4g} m;"
        " grips, eyes or splices in it make strain too small and moduli too large",
    ),
    "tape-off-crosshead": (
        "warning",
        "at the holds of {n_marks} marks the crosshead is {apart:+.4g} m off the tape, more than"
        " the errors of both explain: is its zero right?",
    ),
    "splice-laws": (
        "note",
        lambda law, weight, chance, second, effect: (
            f"splices follow the law {law} (weight {weight:.2f}, chance of its misfit {chance:.2g})"
            + (f"; {second} would move moduli by {100 * effect:+.1f} %" if second else
               "; no other law passes")
        ),
    ),
    "mark-set-aside": (
        "warning",
        "the mark of test {test} at {hold} lies more than four standard errors off every law of the"
        " splices, and is set aside",
    ),
    "splices-slip": (
        "warning",
        lambda slip: (
            f"the splices slip between tests, by {1000 * slip:.1f} mm (standard deviation): each"
            " test has the offset that its own marks say"
        ),
    ),
    "gauge-length-exact": (
        "note",
        "the gauge length counts as exact: its standard uncertainty is not stated, and that of"
        " strain leaves it out",
    ),
    "other-free-length": ("note", "of another free length: {length:.4g} m"),
    "diameters-contradict": (
        "warning",
        lambda implied, stated, allowed, effect: (
            f"the stretched diameters imply {1e3 * implied:.2f} mm before stretch at constant"
            f" volume, {1e3 * stated:.2f} mm is stated, and reading scatter explains no more than"
            f" {1e3 * allowed:.2f} mm; with the implied diameter every modulus and stress of this"
            f" specimen would be {_against(effect, 'higher', 'lower')}"
        ),
    ),
    "no-diameter": (
        "refusal", "no diameter is stated: spring constants, but no stress and no modulus",
    ),
}  # fmt: skip

_OF_CYCLES: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "jumps-no-reversals": (
        "note",
        "{n_jumps} jumps of the control channel and back are no reversals, first at {time:g} s",
    ),
    "gaps-end-runs": (
        "note",
        "gaps of the record longer than 30 % of a half cycle, each the end of a run: {n_gaps},"
        " first near {time:g} s",
    ),
    "cycles-of-two-amplitudes": (
        "note",
        "cycles between two amplitudes, one branch of each, not counted: {n_cycles}, first at"
        " {time:g} s",
    ),
    "cycles-of-starting-machine": (
        "note",
        lambda n_first, n_last: (
            f"the machine had not reached its amplitude in the first {n_first} and had left it in"
            f" the last {n_last} cycles, which are not counted"
        ),
    ),
    "counter-constant": (
        "note", "the machine's cycle counter never changes: reversals are counted instead",
    ),
    "counted-without-stroke": (
        "note", "counted cycles without a stroke: {n_cycles}, first machine cycle {first}",
    ),
    "counter-skips": (
        "note",
        "the log holds {n_cycles} of the machine's cycles {first} to {last}: {after} follows"
        " {before}",
    ),
    "counter-differs": (
        "warning",
        "the machine counted {n_counted} cycles with a stroke, the reversals give {n_reversals}"
        " whole ones",
    ),
    "cycles-small": (
        "note",
        "the cycles have a range of {stroke:.4g} {unit} in a record of {of_record:.4g} {unit}: they"
        " were found with a band of {band:.3g} {unit}; state cycles.band for another",
    ),
    "one-cycle": ("note", "one cycle only: there is no scatter from cycle to cycle"),
    "few-samples-a-cycle": (
        "warning",
        "{n_samples:g} samples in a cycle, where {needed} are needed for sound peaks and loops: a"
        " turn between two samples is missed, the spring constant is of what was logged, and"
        " tangent moduli may have no window. Log every {step}, or take the log that was not"
        " thinned",
    ),
    "cycles-not-as-planned": (
        "warning", "{n_found} whole cycles found, {n_planned} planned",
    ),
    "no-plateau": (
        "note",
        "a {waveform} waveform has no plateau of rate: the trimmed branches leave out 5 % of the"
        " stroke at each end",
    ),
    "branches-without-constant-rate": (
        "note",
        "{n_bare} of {n_branches} branches have no part at a constant rate, first near {time:g} s",
    ),
    "strain-impossible": (
        "warning",
        "strain reaches {strain:.4g}, which no specimen does; is the unit of position, or the"
        " length that strain refers to, right?",
    ),
    "cycles-drift": (
        "warning",
        "{n_far} of {n_cycles} cycles drift by more than {limit:.0%} of their range: their"
        " amplitudes, slopes and energies rest on it",
    ),
    "sign-of-tension": (
        "warning",
        "tension falls with stretch (median tangent modulus {slope:.4g} Pa); does the log count"
        " compression positive? Then set sign = -1 for this channel",
    ),
    "loops-run-backward": (
        "warning",
        lambda slope, tension, strain, channel: (
            f"tension falls with stretch ({slope:.4g} N per unit strain, at a mean of {tension:.4g}"
            f" N and {100 * strain:.3g} %): "
            + (
                f"the {channel} channel runs backward; set sign = -1 for it in the layout"
                if channel
                else "one channel runs backward, or what is logged is the inertia of moving parts;"
                " check sign and zero of both"
            )
            + ". Stiffness, loop energy and loss are not given"
        ),
    ),
    "loops-give-work": (
        "warning",
        lambda energy, n_cycles, n_known, delay, stated, time_step, cause: (
            f"{n_cycles} of {n_known} loops give out work ({energy:.4g} J/m on average): tension"
            " rises with stretch, so no channel is reversed, and follows it by"
            f" {1e3 * delay:.3g} ms or more, "
            + {
                "lag": f"within the stated lag of {1e3 * stated:.3g} ms (k=1): it was logged late,"
                " and the loss is not known in sign",
                "sampling": f"less than a sample of {1e3 * time_step:.3g} ms: the channels were"
                " hardly read together; state a lag",
                "driven": (
                    f"more than twice the stated lag of {1e3 * stated:.3g} ms: the specimen is"
                    " driven, or tension was logged later than stated"
                    if stated
                    else "and no lag is stated: tension was logged late by that, or the specimen is"
                    " driven"
                ),
            }[cause]
        ),
    ),
    "loops-not-of-a-sine": (
        "warning",
        lambda share, effect: (
            "the waveform is stated as sinusoidal, and the fundamentals in time would lose"
            f" {share:.3g} times the energy of the loops: the log is no sine (a rise and a fall of"
            " unequal time?); stiffness, loss and amplitudes are those at equal phase of the"
            " stroke, as of any other waveform"
        ),
    ),
    "drift-in-energy": (
        "warning",
        lambda energy, closed, effect: (
            f"the loop area is {closed:.4g} J/m as logged, of which {closed - energy:+.3g} J/m"
            f" ({effect:+.1%} of what is given) is the drift of the"
            f" cycles: the hysteresis energy of {energy:.4g} J/m is without it"
        ),
    ),
    "slack-in-cycles": (
        "warning",
        "slack within {n_slack} of {n_cycles} cycles (tension at or below {slack_tension:.4g} N):"
        " amplitudes and energies of these include the slack part",
    ),
    "no-snap-loads": (
        "note",
        "{n_taut} of {n_cycles} cycles are no snap loads: tension stays above {slack_tension:.4g}"
        " N, so the line does not go slack in them",
    ),
    "not-triangular": (
        "warning",
        "declared triangular, but only {share:.0%} of the branches run at a constant rate; is"
        ' waveform = "sinusoidal" right?',
    ),
    "stated-lag-long": (
        "warning",
        "the stated lag of {lag:.4g} s is more than a twentieth of {n_short} of {n_cycles} cycles,"
        " the shortest of {shortest:.4g} s: what it does to stiffness and loss is of first order,"
        " and their uncertainties are too small",
    ),
    "inertia-taken-off": (
        "note",
        lambda mass, force, width, n_lost, cell: (
            f"tension is that of the specimen: the inertia of {mass:.4g} kg at its moving end, up"
            f" to {force:.4g} N, is taken off what the load cell at the {cell} end felt;"
            f" acceleration from the position, in windows of {width:.3g} s"
            + (
                f"; {n_lost} samples of the cycles have none, and no tension"
                if n_lost else ""
            )
        ),
    ),
    "give-taken-off": (
        "note",
        "position is that of the specimen: {compliance:.4g} m/N times the tension, up to"
        " {length:.4g} m, is taken off what the crosshead's scale saw",
    ),
    "attached-mass-unknown": ("note", _unknown_mass),
    "attached-mass-matters": ("warning", _unknown_mass),
    "own-mass-unknown": (
        "note",
        "the inertia of the specimen itself is not corrected for (that takes load_cell_at and"
        " linear_density): a mass of {at_moving:.3g} kg between its ends would move K_ap by its"
        " standard uncertainty under a load cell at the moving end, {at_fixed:.3g} kg under one at"
        " the fixed end",
    ),
    "compliance-unknown": ("note", _unknown_compliance),
    "compliance-matters": ("warning", _unknown_compliance),
    "tension-late": (
        "warning",
        lambda lag, spread, stated: (
            f"tension turns {1e3 * lag:.0f} +- {1e3 * spread:.0f} ms (k=1) later than position, and"
            f" {f'a lag of 0 +- {1e3 * stated:g} ms is stated' if stated else 'no lag is stated'}:"
            " it was logged late, by at least that, since damping makes it turn early; nothing is"
            " corrected, and loops are too narrow by it"
        ),
    ),
}  # fmt: skip

_OF_MODULI: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "break-in-left-out": ("note", "the first {n_cycles} cycles (break-in) are not in the mean"),
    "no-tangent-modulus": (
        "refusal",
        "specimen {place} of the record has no tangent modulus: no window has enough samples",
    ),
    "cycles-aligned": (
        "note",
        "the mean strain of the cycles drifts by {drift:+.3%} from the first to the last"
        " ({effect:.0%} of the range of a cycle; {per_decade:+.3%} per decade of cycles): curves"
        " are those of cycles shifted to a mean strain of {reference:.3%}, and tension at a strain"
        " is that of such a cycle",
    ),
    "bins-of-some-cycles": (
        "refusal",
        "specimen {place} of the record: curves are given at {n_given} of {n_bins} strains (of both"
        " branches together); fewer than {least:.0%} of the cycles reach the others, and a mean"
        " over some cycles is no curve of the test",
    ),
    "samples-off-grid": (
        "warning",
        "{n_samples} samples of branches lie off the strain grid and are in no curve: their strain"
        " is outside the reversals of all cycles",
    ),
    "identity-open": (
        "warning",
        lambda effect, error, is_coarse: (
            "the mean slopes of the two branches and the tension lost in a cycle do not agree:"
            f" {effect:+.1%} of the modulus is left (standard error {error:.1%}). Possible causes:"
            " a lag between the channels, a dwell at the turns, slip or slack"
            f"{', or too few samples for the curvature' if is_coarse else ''}"
        ),
    ),
    "slip-cycles-missing": (
        "note", "slip not looked for: {n_missing} of {n_cycles} cycles are missing",
    ),
    "tension-steps-up": (
        "warning",
        "tension steps up at cycle {cycles}; a splice cannot take up length, look at the zero of"
        " the load cell and the set point of the crosshead",
    ),
    "specimens-step-together": (
        "warning",
        "two specimens step at cycle {cycle}: look at the crosshead before the splices",
    ),
    "no-common-strain": ("refusal", "{above} and {below} have no strain in common"),
    "unequal-condition": ("note", "unequal before the campaign: condition {told}"),
    "history-without-order": (
        "note", "what earlier tests did to either is not known: no order is given",
    ),
    "history-with-failed-tests": (
        "note", "what earlier tests did to them is not wholly known: one of those failed",
    ),
    "unequal-cycles": (
        "note",
        "unequal histories in the campaign: {cycles:.0f} earlier cycles against {of_first:.0f}",
    ),
    "unequal-flex-cycles": (
        "note", "unequal histories in the campaign: {told} earlier flex cycles",
    ),
    "unequal-strain": (
        "note", "unequal histories in the campaign: greatest earlier strain {told}{softer}",
    ),
    "law-not-fitted": ("refusal", "not fitted: {reason}"),
    "law-not-told-from-zero": ("note", "not told from zero: {names}"),
    "law-not-stable": (
        "note",
        lambda strain: (
            f"the fitted law is not stable: below a strain of {100 * strain:.3g} % its stress falls"
            " with strain in uniaxial, biaxial or shear deformation; do not use it in a model"
        ),
    ),
    "law-without-pull": (
        "refusal",
        "no hyperelastic law: the first rise of the record is no pull from slack ({reached}); is"
        " the kind of the test right, and where strain is zero?",
    ),
    "no-law": ("refusal", "no hyperelastic law from the first loading: {reason}"),
    "law-of-softened-rubber": (
        "note",
        lambda strain: (
            f"not a first loading of the specimen: earlier tests reached {100 * strain:.0f} %, and"
            " below that the rubber is softened"
            if strain == strain
            else "not a first loading of the specimen: how far earlier tests reached is not known"
        ),
    ),
    "stress-at-strain-not-given": (
        "refusal",
        lambda level, reason: f"stress at {100 * level:g} % not given: {reason}",
    ),
    "slack-strain-not-given": (
        "refusal", "slack strain at unloading not given: {reason}",
    ),
    "gauge-length-contradicted": (
        "warning",
        lambda stated, low, high: (
            f"the stated gauge length {1e3 * stated:.1f} mm is not used: it would give strains of"
            f" {100 * low:.0f} to {100 * high:.0f} %, which the recorded elongations contradict"
        ),
    ),
    "length-error-from-scatter": (
        "note",
        lambda scatter: (
            "the uncertainty of a length is not stated; the scatter between length and recorded"
            f" elongation, {1e3 * scatter:.2f} mm, is taken for it"
        ),
    ),
    "reading-inconsistent": (
        "warning",
        lambda length, strain, recorded, corrected, speaks_for, beside: (
            f"length {1e3 * length:.1f} mm is {100 * strain:.0f} %, recorded is"
            f" {100 * recorded:.0f} %; the row gives no modulus. A length of"
            f" {1e3 * corrected:.1f} mm would agree"
            f"{f' (the eye-to-eye length speaks for the {speaks_for})' if speaks_for else ''}, and"
            f" the intervals beside it would be"
            f" {' and '.join(f'{one / 1e6:.2f}' for one in beside)} MPa"
        ),
    ),
    "reading-of-creep": (
        "warning",
        lambda elapsed, weight, growth: (
            f"in {elapsed / 60:.0f} min the weight changed by {weight:+.1f} N and the length by"
            f" {1e3 * growth:+.1f} mm: creep, not elasticity"
        ),
    ),
}  # fmt: skip

_OF_HOLDS: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "no-hold": (
        "refusal",
        lambda slack_tension, channel, tolerance, unit, duration, key: (
            "refused: everything about holds: none is found; above the slack tension of"
            f" {slack_tension:.3g} N {channel} nowhere keeps within {tolerance:.3g} {unit} for"
            f" {duration:g} s (kind and control right? else state phases.{key})"
        ),
    ),
    "hold-samples-left-out": ("note", "{n_left_out} of {n_samples} samples left out"),
    "hold-empty": ("refusal", "refused: everything: {n_samples} samples in the hold"),
    "hold-too-short": (
        "refusal",
        "refused: drop, rate per decade, Prony series: the hold is too short: {duration:.3g} s;"
        " {needed:g} s or more are needed",
    ),
    "hold-too-few-samples": (
        "refusal",
        "refused: drop, rate per decade, Prony series: too few samples: {n_samples}; {needed} are"
        " needed",
    ),
    "hold-slack": (
        "refusal",
        "refused: drop, rate per decade, Prony series: the specimen is slack: {tension:.3g} N; more"
        " than {slack_tension:.3g} N is needed",
    ),
    "hold-tension-rises": (
        "refusal",
        "refused: drop, rate per decade, Prony series: tension rises by {rise:.2%} over the hold"
        " (recovery after unloading, or drift)",
    ),
    "hold-crosshead-moves": (
        "refusal",
        lambda motion, worth: (
            "refused: drop, rate per decade, Prony series: the crosshead moves by"
            f" {motion:.2g} m in the hold{f', worth {worth:.3g} N' if worth == worth else ''}"
        ),
    ),
    "hold-settles": (
        "warning",
        "the crosshead moves on by {motion:.2g} m after the ramp, worth {worth:.3g} N ({share:.1%}"
        " of what is lost): drop, rate per decade and Prony series are those of the length at the"
        " end of the ramp, and carry half of it",
    ),
    "hold-start-contradicted": (
        "refusal",
        "refused: drop, rate per decade, Prony series: the log peaks at {peak:.4g} N beside the"
        " end of the ramp, where {initial:.4g} N are found: when the hold begins is not known",
    ),
    "hold-load-late": (
        "warning",
        lambda rise, peak, delay, is_refused: (
            ("refused: initial tension, drop, rate per decade, Prony series: " * is_refused)
            + f"the load rises by {rise:.3g} N to {peak:.4g} N within {delay:.2g} s after the"
            " crosshead has stopped, where a specimen relaxes: it comes late (a filter, a slow load"
            " cell or another clock)"
            + (
                "; take the filter out, or pull more slowly"
                if is_refused
                else ". Initial tension and drop carry twice that rise"
            )
        ),
    ),
    "prony-misses-ramp-end": (
        "refusal",
        "refused: Prony series: it gives {modelled:.4g} N at the end of the ramp, where the log"
        " has {initial:.4g} N +- {spread:.2g} N (one standard uncertainty)",
    ),
    "hold-tension-steps": (
        "refusal",
        "refused: drop, rate per decade, Prony series: tension steps by {step:.3g} N at"
        " {time:.0f} s into the hold, which relaxation does not explain (a slip of the splice?)",
    ),
    "rate-without-ramp": (
        "refusal",
        "refused: rate per decade: the record does not show the ramp, so the time since loading is"
        " not known",
    ),
    "no-rate": ("refusal", "refused: rate per decade: {reason}"),
    "rate-not-told-from-zero": (
        "refusal",
        "refused: rate per decade: a loss of {loss:.2%} +- {spread:.2%} (one standard uncertainty)"
        " is not told from zero",
    ),
    "drop-not-told-from-zero": (
        "refusal",
        "refused: Prony series: a drop of {drop:.2%} +- {spread:.2%} (one standard uncertainty) is"
        " not told from zero",
    ),
    "no-prony-series": ("refusal", "refused: Prony series: {reason} ({found})"),
}  # fmt: skip

_OF_LINE: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "no-slow-pull": ("refusal", "specimen {place} has no {lacking}"),
    "mean-tension-outside-pull": (
        "warning",
        "the mean tension of {mean:.4g} N lies outside the {low:.4g} to {high:.4g} N of the slow"
        " pull of {pull}",
    ),
    "mean-tension-drifts": (
        "warning",
        "the mean tension drifts from {first:.4g} to {last:.4g} N over the run, which changes K_0"
        " by {effect:+.0%}; K_0 is that at {mean:.4g} N",
    ),
    "loops-no-ellipses": (
        "warning",
        "the loops are no ellipses: E'' by area and amplitudes is {ratio:.2f} of E'' of the"
        " fundamental, so K_1 and tau of the fundamental are the sounder ones",
    ),
    "line-uncertainty-skewed": (
        "warning",
        "K_1 and tau: in {n_skewed} of {n_lines} the uncertainty of K_0 is more than {limit:.0%} of"
        " K_1; their standard uncertainties say little",
    ),
    "line-slack-in-loops": (
        "warning",
        "the line goes slack in {n_slack} of {n_loops} loops, and the model of springs and a"
        " dashpot does not hold there",
    ),
    "no-line": ("refusal", "K_1 and tau: {n_lines} of {n_all} are refused: {reason}"),
    "line-by-monte-carlo": (
        "note",
        "K_1 and tau: uncertainty and 95 % interval are by Monte Carlo, where linear propagation"
        " does not hold: the linear one of {worst} is {ratio:.2f} of it",
    ),
    "line-draws-without-solution": (
        "note",
        "K_1 and tau: uncertainty and 95 % interval are by Monte Carlo, where linear propagation"
        " does not hold: {share:.2g} of the draws of loop and slow pull have no K_1 and tau, and"
        " the interval is that of the others",
    ),
    "no-pull": ("refusal", "refused: quasi-static spring constant: {reason}"),
    "hose-pull-misfit": (
        "refusal",
        "refused: quasi-static spring constant: a cubic of strain misses the curve of this hose by"
        " {misfit:.1%} of its strain (rms), more than {limit:.0%}; the curve stands in the samples,"
        " and a comparison with a predicted hose has its slope",
    ),
    "pull-misfit": (
        "warning",
        "a cubic misses the load-strain curve by {misfit:.1%} of its strain (rms): strain and K_0"
        " by it are no values to design by",
    ),
    "pull-falls": (
        "note", "tension falls by {fall:.1%} of the rise on the way to the peak",
    ),
    "pull-rate-uneven": (
        "note",
        "the strain rate is uneven: from {low:.2g} to {high:.2g} 1/s over quarters of the range",
    ),
    "pull-length-not-stated": ("note", "the length at which strain is zero is not stated"),
    "pull-off-zero": (
        "note",
        "strain is {strain:+.2%} at the reference tension, so the reference length was read"
        " elsewhere, or the line has lengthened since",
    ),
    "pull-waiting-not-stated": (
        "note", "the time since the last dynamic test is not stated, and K_0 depends on it",
    ),
    "pull-cut-at-turn": (
        "note", "the range of use ends where the slope of the cubic turns",
    ),
    "level-with-few-cycles": (
        "note", "level {level} has {n_cycles} of the {n_asked} cycles asked for",
    ),
    "stiffness-of-few-cycles": (
        "note",
        "dynamic stiffness from {n_cycles} cycles; rope.last_cycles asks for {n_asked}",
    ),
    "stiffness-not-settled": (
        "warning",
        "the dynamic stiffness has not settled: it changes by {effect:+.1%} over its last"
        " {n_cycles} cycles",
    ),
    "cycles-of-another-level": (
        "note",
        "{n_other} of {n_cycles} cycles are of another level than the last ones, of which the"
        " dynamic stiffness is; give each level as a step",
    ),
    "no-bedding-in": ("refusal", "refused: bedding-in: one cycle alone; two are needed"),
    "first-cycle-begins-elsewhere": (
        "note",
        "the first cycle begins at {first:.4g} N, others at {usual:.4g} N: its stiffness and the"
        " permanent strain hold that part of the rise too",
    ),
    "cycles-counted-until": ("note", "{how}"),
    "no-static-stiffness": ("refusal", "refused: static stiffness: {reason}"),
    "stiffness-beyond-hold": (
        "warning",
        "the stiffness at {reference:g} s is read off the line beyond the hold, which has readings"
        " from {first:.3g} to {last:.3g} s",
    ),
    "no-break": (
        "refusal",
        "refused: tensile strength: {how}: the line holds {tension:.4g} N or more",
    ),
    "no-strain-at-failure": (
        "refusal", "refused: strain at failure: no strain is known at the peak",
    ),
    "no-break-strength": (
        "note", "no rated break strength is stated: nothing is divided by it",
    ),
    "no-order": (
        "note",
        "no place in the order of tests is given for {specimens}: what earlier tests did to them is"
        " not known here; set order",
    ),
    "cycles-in-no-log": (
        "note",
        "{n_cycles} earlier cycles are in no log: earlier_maximum_strain and"
        " earlier_maximum_tension are of the logged tests alone",
    ),
    "earlier-test-failed": (
        "note",
        "earlier test {test} failed: what it did to {specimens} is not known, and earlier_cycles,"
        " earlier_maximum_strain and earlier_maximum_tension have no number",
    ),
    "earlier-test-without-strain": (
        "note",
        "earlier test {test} has no strain of {specimens}: earlier_maximum_strain has no number",
    ),
}  # fmt: skip

_OF_EXPERIMENTS: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "run-test-failed": ("warning", "its test failed"),
    "run-without-product": ("warning", "its test gave no product"),
    "run-without-line": ("refusal", "K_1 and tau refused: {reason}"),
    "run-slack": ("warning", "the line goes slack in {cycles}"),
    "same-log": (
        "warning",
        "{tests} have the same log, byte for byte: one run that was copied under another name?",
    ),
    "levels-off-plan": (
        "warning",
        "levels reached disagree with the plan by more than {limit:g} coded: {where}; the surfaces"
        " are of the levels reached",
    ),
    "screening-levels-off-plan": (
        "warning",
        "levels reached disagree with the plan by more than {limit:g} coded: {where}; they count as"
        " those of the plan",
    ),
    "no-main-part": ("refusal", "refused: {part}: {reason}"),
    "no-surface": (
        "refusal",
        "refused: surface of {responses}: {reason} ({n_runs} runs of {n_all}, {n_terms}"
        " terms){causes}",
    ),
    "no-effect": (
        "refusal",
        lambda responses, reason, without: (
            f"refused: effects on {responses}: {reason}"
            f"{f'; no value of {without}' if without else ''}"
        ),
    ),
    "error-by-lenth": (
        "note",
        "no columns dummy_1, ..: the error is Lenth's, from the smaller effects themselves",
    ),
    "effects-over-blocks": (
        "note", "the effects are over all blocks; differences of blocks are in their error",
    ),
    "scale-by-runs": (
        "note",
        "{response} is read from the surface of {scale}: about that of the usual scale the runs"
        " scatter {ratio:.3g} times as much (p = {p:.2g})",
    ),
    "slow-pull-error-shared": (
        "note",
        "t and p of the surfaces of K_1 and tau are of the scatter of the runs; the error of K_0,"
        " which all runs of one slow pull share, is in the uncertainty of the coefficients alone",
    ),
    "no-reduction-of-terms": ("refusal", "refused: reduction of terms: {reason}"),
    "terms-chosen-by-runs": (
        "note", "the runs that are tested chose the terms: p and intervals are too small",
    ),
    "no-stiffness-forms": (
        "refusal", "refused: stiffness forms of mooring codes: {reason}",
    ),
    "stiffness-forms-pooled": (
        "note",
        "stiffness forms of mooring codes pool the specimens: what sets one apart from another is"
        " in their scatter",
    ),
    "no-derived-line": (
        "refusal", "refused: K_1 and tau from surfaces of E' and E'': {reason}",
    ),
    "no-check-of-single-time": (
        "refusal", "refused: check of a single relaxation time: {reason}",
    ),
    "single-time": ("note", "{verdict}"),
    "runs-without-value": ("note", "runs without any value: {runs}"),
    "responses-miss-runs": ("note", "responses that miss further runs: {responses}"),
    "surface-not-fitted": ("refusal", "{responses}: {reason}"),
    "surface-not-judged": ("note", "{responses}: {reason}"),
    "runs-alike": (
        "warning",
        "runs {first} and {second} agree in every level and response ({n_pairs} such pairs):"
        " repeats, or one run twice?",
    ),
    "repeats-differ": (
        "warning",
        "repeated runs differ by up to {spread:.2g} in coded levels (tolerance {tolerance:g}): pure"
        " error is taken after the surface has moved them together",
    ),
    "levels-off-range": (
        "note", "levels of {factor} {how} the plan: {low:.2f} to {high:.2f} coded",
    ),
    "runs-fix-terms": (
        "note", "runs that fix a term alone and have no residual to check: {runs}",
    ),
    "terms-lean": (
        "note",
        "terms lean on each other: condition number {condition:.0f}, that of fifteen Box-Behnken"
        " runs met exactly is 4.24",
    ),
    "blocks-fixed": (
        "note",
        "{n_specimens} specimens as fixed blocks: every term is judged by the residuals, which hold"
        " each specimen's own answer to the factors; the mean is of these specimens",
    ),
    "blocks-random": (
        "note",
        "{n_specimens} specimens as random draws (REML): the mean is judged by the scatter between"
        " specimens ({freedom} degrees of freedom), the other terms by the residuals within; r2,"
        " analysis of variance, lack of fit and residuals are those of fixed blocks",
    ),
    "surface-below-zero": (
        "warning",
        "the surface of {response} goes below zero among the levels, where no run does: transform ="
        ' "log" keeps it above',
    ),
    "response-drifts": (
        "warning",
        "{response} drifts over the order of the runs beyond its surface: {slope:+.3g} a run (p"
        " {p:.2g})",
    ),
}  # fmt: skip

_OF_HOSES: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "layer-stretched": (
        "warning",
        lambda layer, strain, limit, angle: (
            f"layer {layer} is stretched by {100 * strain:.1f} % at the working load, above its"
            f" {100 * limit:g} %: it needs {degrees(angle):.1f} degrees or more"
        ),
    ),
    "layer-compressed": (
        "warning",
        lambda layer, strain, limit, angle: (
            f"layer {layer} is compressed by {-100 * strain:.1f} % on the way, above its"
            f" {100 * limit:g} %: it needs {degrees(angle):.1f} degrees or less"
        ),
    ),
    "layer-without-angle": (
        "warning",
        "layer {layer}: no angle keeps it within both limits up to the working load",
    ),
    "no-slack-zone": (
        "note",
        lambda angle: (
            f"at {degrees(angle):.2f} degrees there is no slack zone: the cords carry from the"
            " first"
        ),
    ),
    "cords-touch": (
        "warning",
        "neighbouring cords touch {where} % strain: the prediction does not hold there",
    ),
    "bore-too-small": (
        "warning",
        "the bore is below its limit {where} % strain: the prediction does not hold there",
    ),
    "cords-broken": (
        "refusal",
        lambda strain: f"the cords are broken from {100 * strain:.1f} % strain: no load is given",
    ),
    "hose-without-uncertainty": (
        "note", "no number of the hose has a stated uncertainty: none is given",
    ),
    "working-load-uncertain": (
        "warning",
        lambda effect: f"the safe working load is uncertain by {100 * effect:.0f} % (k = 1)",
    ),
    "cycles-pooled": ("note", "each row pools {n_cycles} consecutive cycles"),
    "one-branch": (
        "note",
        "one branch was measured: it is judged itself, and lies above a midline by half the loop",
    ),
    "numbers-not-told-apart": (
        "warning",
        lambda names, words, needed: (
            f"this curve cannot tell {names} apart: {words}, less than the {100 * needed:.2g} %"
            " that an error of the model may be; the values are one choice of many, and their"
            " intervals are as wide as such an error makes them"
        ),
    ),
    "number-not-shown": (
        "warning",
        lambda names, words, needed: (
            f"this curve does not show {names}: {words}, less than the {100 * needed:.2g} % that an"
            " error of the model may be"
        ),
    ),
    "number-at-bound": (
        "warning", "{name} was stopped at a bound: its interval does not hold",
    ),
    "number-not-determined": (
        "warning",
        "the interval of {name} is wider than half of what it was allowed: not determined",
    ),
    "residuals-are-model": (
        "note",
        "residuals are worth {n_points:.1f} independent points for {n_numbers} numbers: what is"
        " left is an error of the model, not noise",
    ),
    "source-far-off": (
        "note", "{name} would have to be {factor:+.1f} of its standard uncertainty off",
    ),
    "fitted-cords-broken": (
        "warning",
        "cords of the fitted hose are broken at {n_strains} of the measured strains: there it was"
        " held against its tangent",
    ),
    "number-moved-far": (
        "note", "{name} moved by {factor:+.1f} of its stated standard uncertainty",
    ),
    "pick-up-not-shown": (
        "refusal", "where the cords of the test pick up is not shown: {reason}",
    ),
    "dynamic-test": (
        "note",
        "the test is dynamic and the cord curve static: nylon is stiffer under quick load, so that"
        " a prediction is expected to stretch more than this test; a difference is not of the model"
        " alone",
    ),
    "test-beyond-break": (
        "warning",
        "the test went on to strain {strain:.4g}; cords are predicted broken at {n_broken} of its"
        " {n_strains} strains, which are in no difference",
    ),
    "curve-ends-early": (
        "note",
        "the judged curve ends at strain {strain:.4g}, before the predicted working load",
    ),
    "stretch-beside-reported": ("note", "{side} {words}"),
    "prediction-counts-as-exact": (
        "note",
        "no uncertainty of the prediction is stated: it counts as exact, and a difference that the"
        " angle or the cord curve would explain counts against it",
    ),
    "test-counts-as-unbiased": (
        "note", "no uncertainty of the calibration is stated: the test counts as unbiased",
    ),
    "load-cell-counts-as-exact": (
        "note", "nothing is stated of the load cell: its scale and its zero count as exact",
    ),
    "shape-differs": (
        "warning",
        "no strain differs by more than U, but the shape of the difference is one that the stated"
        " errors make in {probability} of all cases alone",
    ),
    "difference-without-error": (
        "warning",
        lambda effect: (
            f"{100 * effect:.2g} % of the squared difference lies where no stated error can be"
        ),
    ),
    "taken-as-dynamic": (
        "note", 'taken as dynamic, as {kind} tests are; a slow one has loading = "static"',
    ),
    "from-stored-samples": (
        "note", "from the samples that are stored of a long record: {samples}",
    ),
    "no-curve-of-errors": (
        "note",
        "the archive of the test holds no curve with what its instruments may be wrong by (a"
        " specimen without a diameter has none): what is stated of load and crosshead is not in the"
        " comparison",
    ),
}  # fmt: skip

_OF_PLAUSIBILITY: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "modulus-outside-band": (
        "warning",
        lambda modulus, low, high, of, readings: (
            f"greatest stress over greatest strain is {_pascals(modulus)}, and that of {_one(of)}"
            f" lies between {_pascals(low)} and {_pascals(high)}: is the unit of load, the"
            f" diameter, the gauge length or the material right?{_would_fit(readings)}"
        ),
    ),
    "strength-outside-band": (
        "warning",
        lambda found, low, high, of, readings: (
            f"rated_break_strength over the area of the diameter is {_pascals(found)}, and that of"
            f" {_one(of)} lies between {_pascals(low)} and {_pascals(high)}: is the diameter, the"
            f" strength, its unit or the material right?{_would_fit(readings)}"
        ),
    ),
    "density-outside-band": (
        "warning",
        lambda found, low, high, of, readings: (
            f"linear_density over the area of the diameter is {found:.3g} kg/m3, and that of"
            f" {_one(of)} lies between {low:.3g} and {high:.3g}: is the unit of linear_density, the"
            " diameter or the material right?"
        ),
    ),
    "strain-above-band": (
        "warning",
        lambda strain, limit, of: (
            f"strain reaches {100 * strain:.3g} %, and {_one(of)} breaks below {100 * limit:.3g} %:"
            " is the gauge length, the unit of position or of the extensometer, or the material"
            " right?"
        ),
    ),
    "tension-above-strength": (
        "warning",
        lambda share: (
            f"tension reaches {100 * share:.0f} % of the rated_break_strength and the test is not"
            " said to have failed: is the unit or the gain of the load, or the"
            " rated_break_strength right?"
        ),
    ),
    "tension-far-below-strength": (
        "warning",
        lambda share: (
            f"tension reaches {100 * share:.2g} % of the rated_break_strength alone: is the unit or"
            " the factor of the load, or the unit of the rated_break_strength right?"
        ),
    ),
    "diameter-readings-apart": (
        "warning",
        lambda least, greatest: (
            f"readings of the diameter are {1e3 * least:.4g} to {1e3 * greatest:.4g} mm: is one of"
            " them a slip?"
        ),
    ),
    "rate-not-as-stated": (
        "warning",
        lambda stated, found, unit, ratio, like: (
            f"the log shows a rate of {found:.3g} {unit}, {ratio:.3g} times the stated rate of"
            f" {stated}{_is_like(like)}: is the unit of time, the sampling interval, the unit of"
            " position or the rate right?"
        ),
    ),
    "target-strain-missed": (
        "warning",
        lambda reached, target, ratio, like, method: (
            f"strain reaches {100 * reached:.3g} %, {ratio:.3g} times the target_strain of"
            f" {100 * target:.3g} %{_is_like(like)}: is "
            + (
                "the gauge length the free length between the splices (not eye to eye), and its"
                " unit right?"
                if method == "gauge-length"
                else "the unit of the extensometer right?"
                if method == "extensometer"
                else "the unit of position and of the marks, or the target_strain right?"
            )
        ),
    ),
    "level-not-as-stated": (
        "warning",
        lambda level, stated, found, unit, ratio, like: (
            f"the log shows a {level} of {found:.4g} {unit}, {ratio:.3g} times the stated {level}"
            f" of {stated}{_is_like(like)}: is its unit, or that of the log, right?"
        ),
    ),
    "cycles-in-other-kind": (
        "warning",
        "the log holds about {n_cycles} cycles and its kind is {kind}: is the kind right?",
    ),
    "break-in-is-all": (
        "warning",
        "break_in_cycles is {break_in} and the log holds {n_cycles} cycles: none is left",
    ),
    "pull-below-runs": (
        "warning",
        "the slow pull ends at {reached:.4g} N, below the mean tension of every run ({least:.4g} N"
        " at the least): K_0 is not known where the runs are",
    ),
    "hose-unlike-design": (
        "warning",
        lambda hose, ratio, strain, like: (
            f"at {100 * strain:.3g} % it pulls {ratio:.3g} times what its design {hose} gives"
            f"{_is_like(like)}: is the unit of load, the gauge length, the file and hose that are"
            " named (not swapped), the inner diameter (bore), the length, or the number, angle and"
            " load of its cords (both layers counted once) right?"
        ),
    ),
    "waveform-not-as-stated": (
        "warning",
        "the waveform is stated as {stated}, and that of the log is {found}: is waveform right?",
    ),
    "gauge-against-length": (
        "warning",
        lambda gauge, length, like: (
            f"the gauge length is {gauge:.4g} m, and the pins are {length:.4g} m apart at slack"
            f"{_is_like(like)}: is the gauge length, its unit or the unit of position right?"
        ),
    ),
    "extensometer-against-stroke": (
        "warning",
        lambda ratio, like: (
            "the measured strain falls where the crosshead position rises: does one of them count"
            " the other way? Then set sign = -1 for it"
            if ratio < 0
            else f"the measured strain is {ratio:.3g} times the stroke over the length at slack"
            f"{_is_like(like)}: is the unit or the range (gain) of the extensometer, or the unit of"
            " position (stroke) right?"
        ),
    ),
    "extensometer-off-at-slack": (
        "warning",
        "the extensometer reads {strain:.3%} where the specimen is slack: was it set to zero"
        " there?",
    ),
    "channels-alike": (
        "warning",
        "the tension is identical to that of {others}, reading by reading: do both channels name"
        " one column, or were two cables joined to one load cell?",
    ),
    "column-of-another": (
        "warning",
        "its tension is read from the column {column!r}, which has the name of {other}: are the"
        " columns swapped?",
    ),
    "log-used-twice": (
        "warning", "its log is that of test {other}, byte by byte: is the same file named twice?",
    ),
    "stiffness-jumps": (
        "warning",
        lambda other, ratio, like: (
            f"it is {ratio:.3g} times as stiff as in {other}{_is_like(like)}: is"
            " the unit, gain or factor of the load that of the other test, and is it the file and"
            " the specimen that are named (not swapped)?"
        ),
    ),
    "tension-behind-position": (
        "warning",
        "tension lags position by {delay:.2g} s, which no specimen does: was the load logged late,"
        " or through a filter? Loops and moduli are wrong by it",
    ),
    "position-behind-tension": (
        "warning",
        "tension leads position by {delay:.2g} s, more than the damping of a specimen explains: was"
        " the position logged late, or does mass beside a moving load cell add its inertia?",
    ),
    "load-falls-for-good": (
        "warning",
        "the load ends at {share:.0%} of its greatest while the crosshead stays out: did the"
        " specimen break or slip? Then state failed = true",
    ),
    "run-off-plan": (
        "warning",
        lambda experiment, levels, why, like: (
            f"not at the levels of {experiment}: {levels}"
            + (f"; {why}" if why else "")
            + (f"; these are the levels of {like}: are files or rows swapped?" if like else "")
        ),
    ),
    "cord-stress-outside-band": (
        "warning",
        lambda stress, low, high: (
            f"its cords break at {_pascals(stress)} of their section, and cords of textile at"
            f" {_pascals(low)} to {_pascals(high)}: is the unit of the cord's load (of one cord,"
            " not of the fabric), or the cord_diameter right?"
        ),
    ),
    "cords-do-not-fit": (
        "warning",
        lambda share: (
            f"cords_per_length times cord_diameter is {share:.3g} of the width"
            + (
                ", so that cords overlap: are both layers counted, or is a unit wrong?"
                if share > 1
                else ": is the unit of cords_per_length or of cord_diameter right?"
            )
        ),
    ),
    "hose-rubber-outside-band": (
        "warning",
        lambda modulus, low, high: (
            f"its rubber_modulus is {_pascals(modulus)}, and Young's modulus of hose rubber is"
            f" {_pascals(low)} to {_pascals(high)}: is its unit right, or is it a shear modulus?"
        ),
    ),
    "wrap-angle-outside-band": (
        "warning",
        lambda angle: (
            f"its wrap_angle is {degrees(angle):.3g} degrees from the axis, and a hose stretches"
            " where it is above 55: was it measured from the hoop, or is it in radians?"
        ),
    ),
    "dead-length-large": (
        "warning",
        "{share:.0%} of its length is dead_length: is the unit of dead_length or of length right?",
    ),
    "hose-not-of-design": (
        "warning",
        lambda hose, ratio, like: (
            f"its diameter is {ratio:.3g} times the outer_diameter of {hose}, which it is held"
            f" against{_is_like(like)}: is the diameter (not the wall) in the right unit?"
        ),
    ),
}  # fmt: skip

SENTENCES: Mapping[str, tuple[Severity, str | Callable[..., str]]] = {
    **_OF_READING, **_OF_STRAIN, **_OF_CYCLES, **_OF_MODULI, **_OF_HOLDS, **_OF_LINE,
    **_OF_EXPERIMENTS, **_OF_HOSES, **_OF_PLAUSIBILITY,
}  # fmt: skip
"""By code: how serious a note is, and its sentence."""

CAUSES = (
    "log-used-twice", "channels-alike", "column-of-another", "diameter-readings-apart",
    "cycles-in-other-kind", "rate-not-as-stated", "level-not-as-stated",
    "load-zero-wrong", "load-negative", "load-falls-with-stretch", "tape-off-crosshead",
    "loops-run-backward", "extensometer-against-stroke", "gauge-against-length",
    "modulus-outside-band", "strength-outside-band", "tension-above-strength", "stiffness-jumps",
    "run-off-plan", "cord-stress-outside-band", "cords-do-not-fit", "hose-rubber-outside-band",
    "wrap-angle-outside-band", "dead-length-large", "hose-not-of-design", "hose-unlike-design",
    "target-strain-missed", "density-outside-band", "strain-above-band",
    "extensometer-off-at-slack", "reference-tension-elsewhere", "strain-below-zero",
    "tension-late", "tension-behind-position", "loops-give-work", "loops-not-of-a-sine",
    "hold-load-late",
)  # fmt: skip
"""What is wrong with an input as it was stated, first what explains those behind it."""
