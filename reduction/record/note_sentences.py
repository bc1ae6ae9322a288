"""Severity of each note and the sentence shown to the user, by code.

A sentence is a format string filled with the numbers of the note, or a function of them where a
format string is not enough.  The meaning of a code never changes.
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
    """An absolute change in percent, with its direction."""
    return f"{100 * abs(change):.1f} % {more if change > 0 else less}"


def _pascals(value: float) -> str:
    """A stress in MPa or GPa."""
    return f"{value / 1e9:.3g} GPa" if abs(value) >= 1e9 else f"{value / 1e6:.3g} MPa"


def _newtons(value: float) -> str:
    """A force to four digits, without a power of ten."""
    return f"{float(f'{value:.4g}'):,.10g} N"


def _one(of: str) -> str:
    """A kind with its article."""
    return f"{'an' if of[0] in 'aeiou' else 'a'} {of}"


def _would_fit(readings: str) -> str:
    """Readings that would bring a number into its band, as a separate sentence."""
    return f" It would fit with: {readings}" if readings else ""


def _is_like(like: str) -> str:
    """Possible explanation of a ratio, in brackets."""
    return f" (as {like})" if like else ""


def _left_out(n_cycles: int) -> str:
    """Number of cycles between levels, as part of a sentence."""
    return f" ({n_cycles} cycle{_plural(n_cycles)} between them in none)" if n_cycles else ""


def _unknown_mass(mass: float, usual: float, effect: float, cell: str, is_hose: bool) -> str:
    """Effect of an unstated attached mass."""
    lacks = (
        "the mass between specimen and moving load cell is not stated"
        if cell
        else "the position of the load cell and the mass attached to it are not stated"
    )
    return (
        f"{lacks}: {mass:.3g} kg at a moving load cell would change EA by one standard uncertainty,"
        f" {usual:g} kg ({'two pipe flanges of 2 in' if is_hose else 'a grip for 22 kN'}) by"
        f" {effect:+.2%}; a load cell on the fixed frame is not affected. State load_cell_at and"
        " attached_mass in the layout"
    )


def _slip_in_words(length: float) -> str:
    """Remark on a length known to about 10 mm, for a survey and a test alike."""
    if length != length:
        return "an unknown length"
    whole = 1000 * length
    return f"about {whole if whole < 50 else round(whole, -1):.0f} mm or more"


def _share(error: float) -> str:
    return "below 0.05 %" if error < 5e-4 else f"{100 * error:.1f} %"


def _slack_growth(growth: float, effect: float) -> str:
    return (
        f"the slack length grows by {1e3 * growth:.0f} mm ({effect:.1%}) from the first"
        " test to the last (permanent set, or a splice that slipped; else check the slack row of"
        " the first test); strain refers to the mean slack length, and the intervals allow for"
        " another length in each test"
    )


def _unknown_friction(size: float, of_energy: float, of_constant: float) -> str:
    return (
        "no mark was read during unloading: if friction makes the extension of the splices"
        f" {size:.0%} larger there than during loading, the hysteresis energy is too large by"
        f" {of_energy:.0%} and EA by {of_constant:.1%}. Read marks during unloading"
        ' (hold "centre down"), or state splice_friction in [uncertainty]'
    )


def _unknown_compliance(compliance: float, usual: float, effect: float) -> str:
    """Effect of an unstated machine compliance."""
    return (
        f"the compliance of frame, load cell and grips is not stated: {compliance:.3g} m/N would"
        f" change EA by one standard uncertainty, {usual:.2g} m/N (a frame for 100 kN, without"
        f" grips) by {effect:+.2%}. State machine_compliance in the layout"
    )


def _unknown_hysteresis(reversibility: float, play: float | None) -> str:
    """Effect of a load cell or a position that reads other values on the way down."""
    or_play = "" if play is None else f", or {1000 * play:.2g} mm of play in the position,"
    return (
        f"the hysteresis of the load cell is not stated: {reversibility:.2%} at half its"
        f" load{or_play} would change the hysteresis energy by one standard uncertainty."
        " State reversibility in [uncertainty.tension], from the calibration"
    )


def _unknown_lag(lag: float, usual: float, effect: float) -> str:
    """Effect of an unstated delay between the channels."""
    return (
        f"the lag between tension and position is not stated: {1000 * lag:.2g} ms would change the"
        f" hysteresis energy by one standard uncertainty, {1000 * usual:.2g} ms (a filter of 30 Hz"
        f" in the tension) by {effect:+.1%}. State lag in [uncertainty]"
    )


_OF_READING: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "laboratory": ("note", "{text}"),
    "misprint-corrected": (
        "note", "length at {reading} is {length}, printed {printed} ({erratum})",
    ),
    "steps-overlap": (
        "note",
        "the step overlaps the step '{other}': rows in both are used in both, and their cycles"
        " count twice in the history of the specimen",
    ),
    "log-ends-in-step": (
        "note", "the log ends at {end:.6g} s, before the stated end of the step at {stated:.6g} s",
    ),
    "counter-missing": (
        "note", "the cycle counter is missing in {n_rows} rows; it is set to -1 there",
    ),
    "resampled": (
        "note",
        "{channels}: resampled from {rate:.4g} Hz to the {base_rate:.4g} Hz of {base}, by"
        " cubics through four readings",
    ),
    "interpolated-by-logger": (
        "warning",
        "{channel} runs in straight lines over a few rows each: it was sampled less often than it"
        " was logged, and interpolated. This clips its peaks and hides its noise, so intervals are"
        " too narrow. Log at the channel's own rate",
    ),
    "read-less-often": (
        "warning",
        "{channel} has a new reading every {interval:.3g} s, which the log repeats in {every:.0f}"
        " rows: of its {n_rows} rows only those with a new reading are used. A reading may still be"
        " up to one row ({step:.3g} s) late; the interval includes this as a lag. Log at the"
        " channel's own rate",
    ),
    "rows-sorted": (
        "note",
        lambda n_rows, n_twice, n_moved: (
            "the log was written newest first, so time runs backward: its rows are read in"
            " reverse order"
            if n_moved == n_rows - n_twice - 1
            else "; ".join(
                [f"repeated rows (same time and readings) are left out: {n_twice}"] * bool(n_twice)
                + [f"rows are sorted by time, which goes back at {n_moved} of them"] * bool(n_moved)
            )
            + ". Check whether the logger wrote a buffer twice or late"
        ),
    ),
    "rows-repeated": (
        "note",
        "the log repeats each reading in {every:.0f} rows: of its {n_rows} rows those with new"
        " readings are used, one every {interval:.3g} s",
    ),
    "channels-not-used": ("note", "read and checked, but not used: {channels}"),
    "clock-changed": (
        "warning",
        lambda way, time: (
            f"the clock was set {way} by one hour after {time:.6g} s, as at the "
            + (
                "end of daylight saving time: an hour is added to all later times"
                if way == "back"
                else "beginning of daylight saving time: an hour is subtracted from all later"
                " times. Check that the log did not stop for that hour"
            )
        ),
    ),
    "clock-coarse": (
        "note",
        "the time is in steps of {tick:.3g} s, with {rows:.3g} rows at the same time: the rows are"
        " spread evenly over each step, which agrees with all logged times",
    ),
    "clock-coarse-uneven": (
        "warning",
        "the time is in steps of {tick:.3g} s, with {rows:.3g} rows at the same time on average,"
        " but the number varies: the rows are spread over each step, so rates and frequency are"
        " only as accurate as these steps. Export the time at a finer resolution",
    ),
    "record-of-pieces": ("note", "one record joined from {n_pieces} files: {files}"),
    "reference-length-elsewhere": (
        "warning",
        "reference_length is stated at {stated:.4g} N, but where displacement is first zero the"
        " tension of {specimen} is {found:.4g} N. Check the zero of the load cell, and at which"
        " tension displacement was set to zero",
    ),
    "reference-length-never-read": (
        "warning",
        "displacement is never below {displacement:.4g} m, where {specimen} has a load of only"
        " {load:.3g} N and would be stretched by {strain:.0%} of reference_length: displacement was"
        " not set to zero at this length. State zero ="
        ' "{displacement:.4g} m" of crosshead_position, or the length at displacement zero as'
        " reference_length",
    ),
    "reference-length-under-preload": (
        "warning",
        "reference_length is stated at {stated:.4g} N, but where displacement is first zero the"
        " tension of {specimen} is {found:.4g} N. If the displacement was set to zero under that"
        ' preload, state reference_tension = "{found:.3g} N" beside reference_length; strain is'
        " then zero there",
    ),
    "rows-without-time": (
        "warning",
        "{n_rows} rows have no time, first at sample {sample}: their time is interpolated in even"
        " steps between the neighbouring rows, and their position is not used",
    ),
    "rows-after-the-end": (
        "note",
        "the last {n_rows} rows, from sample {sample} on, have neither time, position nor load: the"
        " log of this test ends before them",
    ),
    "sampling-uneven": (
        "note",
        "the sampling rate is not constant: {n_uneven} of {n_steps} time steps differ by more than"
        " {tolerance:.0%} from their median {median:.4g} s ({shortest:.4g} to {longest:.4g} s, not"
        " counting gaps)",
    ),
    "channel-steps": (
        "note",
        lambda channel, low, high, unit, sample, time, n_more, beside: (
            f"{channel} steps from {low:.4g} to {high:.4g} {unit} between sample {sample}"
            f" ({time:.6g} s) and the next, and stays there, while {beside} not"
            + (f" ({n_more} more such step{_plural(n_more)})" if n_more else "")
            + (
                ". Possible causes: a slip, a break, a re-zeroed channel, or a change of unit;"
                " results across the step mix both states"
                if n_more < JERKS
                else ". So many are not slips: the channel moves in jerks, as with stick-slip or a"
                " stepping motor; they act as noise"
            )
        ),
    ),
    "last-reading-off": (
        "note",
        "the last reading of {channel} is {high:.4g} {unit}, the one before it {low:.4g} {unit}. If"
        " the log was cut off inside its last row, remove this row",
    ),
    "load-steps": (
        "warning",
        lambda channel, low, high, sample, time: (
            f"{channel} steps from {low:.4g} to {high:.4g} N between sample {sample} ({time:.6g} s)"
            " and the next, and the position does not: the range, gain, unit or zero of the load"
            " changed"
            + (", since no slip raises a load" if high > low else ", or the specimen slipped")
            + ". Results mix the loads before and after it: correct the log, or state each part as"
            " a step of its own"
        ),
    ),
    "rows-flagged": (
        "warning",
        lambda n_read, n_kept, flags, of_clock=False: (
            f"flagged, of {n_kept} rows: {flags}. "
            + (
                "The clock of the log stands still or goes back there, and rates and frequencies"
                " use its times. If the rows are evenly spaced, state sample_interval in the layout"
                " instead of the channel time"
                if of_clock
                else "Saturated and stuck readings and spikes are not used, and a cycle that loses"
                " its peak or valley has no EA. Look at them (quality_flag of the archive): where"
                " they are sound, raise reduction.quality.spike_factor or stuck_samples"
            )
        ),
    ),
    "rows-set-aside": (
        "note", "{n_read} rows read, {n_kept} kept, flagged: {flags}",
    ),
    "rows-resampled": (
        "note", "{n_read} rows read, {n_kept} kept, flagged: {flags}",
    ),
    "clock-in-steps": (
        "note",
        "time is written in steps of {step:.3g} s: readings are treated as evenly spaced,"
        " {every:.6g} s apart, which agrees with all logged times",
    ),
    "lines-not-kept": ("note", "{n_lines} further lines without data are not stored"),
    "blocks-read": ("note", "{n_blocks} blocks of data read"),
    "lines-between-blocks-not-kept": (
        "note", "{n_lines} further lines between the blocks are not stored",
    ),
    "blocks-not-read": (
        "note",
        "{n_blocks} blocks of another kind with {n_rows} rows are not read, the first at row {row}",
    ),
    "metadata-left-out": (
        "note", "file attribute {key!r} is not stored: it has {n_characters:,} characters",
    ),
    "blank-rows": ("note", "{n_rows} blank rows at the end of the sheet are ignored"),
    "log-cut-off": (
        "note", "the file ends inside a block of data: the logger was stopped or the file cut off",
    ),
    "levels-found": (
        "warning",
        lambda n_levels, steps, n_left_out: (
            f"the log contains {n_levels} load levels, but no steps are stated: the levels were"
            f" found in the record and are reduced separately{_left_out(n_left_out)}. To fix or"
            f" change them, paste this into the table of the test in campaign.toml: {steps}"
        ),
    ),
    "cycles-unlike": (
        "warning",
        lambda mean, ratio, of_periods, steps: (
            f"the cycles differ (90 % of their mean levels lie within {mean:.0%} of the range of a"
            f" cycle, 90 % of their ranges within a factor of {ratio:.2f}, and 90 % of their"
            f" periods within a factor of {of_periods:.2f}): a mean over them represents none of"
            " them."
            f" {f'Its levels are {steps}' if steps else 'Declare each level as a step of its own'}"
        ),
    ),
    "held-load-repeats": (
        "note",
        "{n_samples} samples in holds at constant tension repeat one value: the flags stuck and"
        " saturated are removed there, since the machine holds the tension",
    ),
}  # fmt: skip

_OF_STRAIN: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "marks-count-as-exact": (
        "note",
        lambda rows="rows": (
            f"the {rows} have no stated reading error, and are too few to estimate one: they are"
            " treated as exact"
        ),
    ),
    "marks-error-from-scatter": (
        "note",
        lambda freedom, rows="rows": (
            f"the {rows} have no stated reading error: it is estimated from their scatter, with"
            f" {freedom} degree{_plural(freedom)} of freedom"
        ),
    ),
    "marks-scatter": (
        "note",
        lambda ratio, chi_square, freedom, chance, rows="rows": (
            f"the {rows} scatter {ratio:.1f} times as much as tape reading explains (chi-square"
            f" {chi_square:.3g} with {freedom} degree{_plural(freedom)} of freedom, probability"
            f" {f'one in {1 / chance:,.0f}' if chance > 1e-6 else 'below one in a million'}); their"
            " uncertainty is increased by this factor"
        ),
    ),
    "constant-fraction-off": (
        "warning",
        lambda low, high, effect: (
            f"strain by constant-fraction misses its own marks by {100 * low:+.1f} to"
            f" {100 * high:+.1f} percentage points; moduli over the marked range are"
            f" {_against(effect, 'too high', 'too low')}"
        ),
    ),
    "marks-differ": (
        "warning",
        lambda method, rms, expected: (
            f"strain by {method} differs from the marks by {100 * rms:.2f} percentage points rms;"
            f" tape reading explains only {100 * expected:.2f}. Check the marks"
        ),
    ),
    "marks-outlier": (
        "warning",
        lambda test, hold, residual: (
            f"the mark of test {test}, hold {hold}, is an outlier: {100 * residual:+.1f} percentage"
            " points off the fit. Check its tape readings"
        ),
    ),
    "slack-length-grows": ("note", _slack_growth),
    "slack-length-grows-far": ("warning", _slack_growth),
    "slack-rows-differ": (
        "warning",
        lambda column, difference, test: (
            f"the {column} of the slack rows differs by {1e3 * difference:.0f} mm, more than the"
            f" error of the tape explains. Check the slack row of test {test}; strain refers to the"
            " mean slack length, and the intervals include the difference"
        ),
    ),
    "splices-unlike": (
        "warning",
        "by the marks, the near splice stretches by {near:.0%} and the far one by {far:.0%}, though"
        " both carry one load. Check near_toe, far_toe and far_thimble, first of the slack rows:"
        " all strain refers to them",
    ),
    "marks-of-failed-tests": (
        "note",
        "{n_marks} of {n_stretched} stretched marks belong to tests that failed ({tests}), so"
        " their tension is not known; the tension law is fitted without them",
    ),
    "marks-without-hold": (
        "note",
        "{n_marks} of {n_stretched} stretched marks match no hold in the logs and are not used",
    ),
    "marks-without-tension": (
        "warning",
        "none of its {n_marks} stretched marks matches a hold in the logs, so their tension is not"
        " known and the strain of the splices follows that of the free length alone. In cycles the"
        " rubber pulls less than at the marks: strain amplitudes may be some percent too large and"
        " EA too small, by more than their intervals. Use logs that begin before the tape is read",
    ),
    "load-zero-wrong": (
        "warning",
        lambda load, n_rests, zero, effect: (
            f"the load cell reads {load:.4g} N at slack ({_rests(n_rests)}),"
            f" {100 * abs(effect):.2g} % of the peak load, and load rises with stretch: its zero is"
            f" wrong{', not its sign' if load < 0 else ', or the specimen pulls there'}. "
            + (
                f'Set zero = "{zero}" for this channel'
                if zero
                else "Set zero for this channel in each layout of the log"
            )
            # a rope cannot push, but a test house may keep it taut
            + (
                "; if it is held at a pretension there, state phases.slack_tension below that load"
                if load > 0
                else ""
            )
        ),
    ),
    "load-zero-drifts": (
        "warning",
        lambda earlier, later, effect, carried: (
            f"the load cell reads {earlier:.3g} N at slack and later {later:.3g} N at no greater"
            f" length, {100 * abs(effect):.2g} % of the peak load: "
            + (
                "its zero drifts (a specimen could pull there only if it had become shorter)"
                if later > earlier
                else "its zero drifts, or the specimen was still taut at the first of these rests"
                " and has become longer"
                if not carried
                else "its zero drifts, since a line cannot push"
            )
            + ". No single zero is right: use the readings at slack to subtract the drift from the"
            " log, or repeat the test. "
            + (
                "The interval of every tension includes the drift"
                if carried
                else "Until then every tension may be wrong by this much"
            )
        ),
    ),
    "load-zero-off": (
        "note",
        lambda load, n_rests, zero: (
            f"the load cell reads {load:.4g} N at slack ({_rests(n_rests)}), more than its noise"
            + (f'. Set zero = "{zero}" for this channel' if zero else "")
            + ". Until then the interval of every tension includes it"
        ),
    ),
    "load-zero-drifted": (
        "note",
        "the zero of the load cell drifts by {drift:.4g} N during the log, more than its stated"
        " uncertainty covers; the interval of tension includes the drift",
    ),
    "load-negative": (
        "warning",
        "load is negative (median {load:.4g} N, minimum {least:.4g} N) and rises with stretch: the"
        " zero of the load cell is wrong, not its sign. The log has no rest at slack, so set zero"
        " for this channel to the unloaded reading",
    ),
    "load-falls-with-stretch": (
        "warning",
        "load is negative (median {load:.4g} N) and falls with stretch. If the log counts"
        " compression as positive, set sign = -1 for this channel; if it is set already, remove it",
    ),
    "length-jumps": (
        "warning",
        lambda what, size, unit, time: (
            f"{what} jumps by {100 * size if unit == '%' else size:+.3g} {unit} at {time:g} s, and"
            " the tension does not follow: it was reset, or something slipped. Strain after the"
            " jump is off by that much; amplitudes and EA are not affected. Correct the log for the"
            " jump"
        ),
    ),
    "specimen-parted": (
        "warning",
        "the load falls to zero at {time:g} s, at a length where the specimen was taut before, and"
        " does not recover: the specimen parted or came loose. The rest of the log is not used",
    ),
    "specimen-parted-as-meant": (
        "note",
        "parted at {time:g} s; the rest of the log is not used",
    ),
    "slipped-in-earlier-step": (
        "warning",
        lambda step, size, what, number: (
            f"in {step} its mean {what} jumped by"
            + (f" {1e3 * size:+.3g} mm" if what == "position" else f" {size:+.3g} N")
            + f" after cycle {number}, and the {'tension' if what == 'position' else 'position'}"
            " did not follow: something slipped"
            + (
                ". Strain in this step is counted from before the jump and is off by that length;"
                " amplitudes and EA are not affected"
                if what == "position"
                else ", or the load cell was knocked. Strain in this step is counted from before"
                " the jump, and tension may be off by that much"
            )
        ),
    ),
    "strain-below-zero": (
        "warning",
        lambda least, tension, reference, rises: (
            f"strain falls to {100 * least:.3g} % at tensions up to {tension:.3g} N, above the"
            f" {reference:.3g} N at which it should be zero: "
            + (
                "crosshead_position is not zero where the specimen has that tension. Check its"
                " zero, and whether the slack rows of the marks, or the gauge length, are of this"
                " specimen"
                if rises
                else "tension rises as crosshead_position falls. If position counts the other way,"
                " set sign = -1 for it"
            )
        ),
    ),
    "bent-at-rest": (
        "note",
        "at the first rest the pins are {length:.4g} m apart, less than the gauge length of"
        " {gauge:.4g} m, near which the specimen starts to carry load: it hangs slack and bent at"
        " the rest, and strain is zero at the gauge length",
    ),
    "zero-behind-load": (
        "warning",
        "strain is zero at a slack rest that the log has only after the specimen was loaded: what"
        " it had lengthened by then is missing from its strains. Log a rest before the test, or"
        " state a displacement from slack, or reference_tension",
    ),
    "slack-beyond-zero": (
        "warning",
        "the log begins {beyond:.4g} m beyond the stated length at slack, with hardly any load;"
        " strain is zero there ({strain:.2%} from the stated length). If the specimen is slack up"
        " to there, state this reading as zero of the position; if not, state reference_tension",
    ),
    "strain-from-tension": (
        "note",
        "strain is zero at the reference tension of {tension:.4g} N, for which the gauge length is"
        " stated",
    ),
    "reference-tension-elsewhere": (
        "warning",
        "the layout puts the reference tension of {tension:.4g} N at {stated:.4g} m, but the log"
        " first reaches it at {found:.4g} m; strain is zero at the latter",
    ),
    "gauge-length-from-reference": (
        "warning",
        "no gauge_length is stated: strain refers to the whole reference_length, {length:.4g} m."
        " If that includes grips, eyes or splices, strain is too low and moduli are too high",
    ),
    "marks-alike": (
        "warning",
        "the marks of holds '{first}' and '{second}' have the same three lengths: one row was"
        " copied. Correct it, or remove it from the marks",
    ),
    "tape-off-crosshead": (
        "warning",
        "crosshead and tape differ by {apart:+.4g} m at the holds of {n_marks} marks, more than"
        " their errors explain. Check the zero of the crosshead, and whether the tape was read from"
        " zero at the near thimble",
    ),
    "splice-laws": (
        "note",
        lambda law, weight, chance, second, effect: (
            f"the splice law that fits best is {law} (weight {weight:.2f}, p-value of its fit"
            f" {chance:.2g})"
            + (f"; {second} would change moduli by {effect:+.1%}" if second else
               "; no other law fits")
        ),
    ),
    "splice-law-unchecked": (
        "warning",
        lambda n_marks, is_one_stretch, carried, effect: (
            (f"the {n_marks} stretched marks are at one stretch: how the splices stretch up to it"
             " and beyond is assumed"
             if is_one_stretch and n_marks > 1
             else "no splice law with fewer coefficients than marks agrees with the"
             f" {n_marks} stretched mark{_plural(n_marks)}; the laws that do agree would also fit a"
             " misread mark")
            + (f"; {carried} would move moduli by {effect:+.1%}, which is in the intervals"
               if carried else "")
            + ". Read marks at one more stretch"
        ),
    ),
    "splice-side-rejected": (
        "note",
        lambda is_strain: (
            f"the marks fit a splice law of {'strain' if is_strain else 'tension'}, and none of"
            f" {'tension' if is_strain else 'strain'}, but tension varies so little at each strain"
            " that only the shape of the laws decides. The mean and the intervals include the"
            f" nearest law of {'tension' if is_strain else 'strain'}; marks in a test with another"
            " range would narrow the intervals"
        ),
    ),
    "splice-friction": (
        "note",
        "marks read during unloading show that the extension of the splices there differs from"
        " their law by {share:+.1%} +- {spread:.1%}; strain is not corrected for this, but the"
        " intervals include it",
    ),
    "splice-creep-unknown": (
        "note",
        "the marks were read in holds: if the splices creep by 10 % of their extension from the"
        " time of a cycle to that of a mark, strain amplitudes are {effect:.1%} too small; the"
        " intervals include 2 %. If splices of this make creep more, state splice_creep in"
        " [uncertainty]",
    ),
    "splice-friction-unknown": ("note", _unknown_friction),
    "splice-friction-matters": ("warning", _unknown_friction),
    "mark-set-aside": (
        "warning",
        "the mark of test {test} at {hold} is an outlier, more than four standard errors off every"
        " splice law, and is not used. Check its tape readings",
    ),
    "splices-slip": (
        "warning",
        lambda slip: (
            f"the splices slip between tests, by {1000 * slip:.1f} mm (standard deviation): each"
            " test gets the offset of its own marks"
        ),
    ),
    "marks-across-slip": (
        "warning",
        "in test {test} the tension fell between two cycles, as when splices slip, and marks read"
        " before and after this are used together: strain and moduli may be off by more than their"
        " intervals. Put the later tests in a campaign of their own, with the marks read in them",
    ),
    "gauge-length-exact": (
        "note",
        "the gauge length is treated as exact: its standard uncertainty is not stated, so the"
        " uncertainty of strain does not include it",
    ),
    "other-free-length": ("note", "measured on a different free length: {length:.4g} m"),
    "diameters-contradict": (
        "warning",
        lambda implied, stated, allowed, effect: (
            f"at constant volume the stretched diameters imply {1e3 * implied:.2f} mm before"
            f" stretch, but {1e3 * stated:.2f} mm is stated; reading scatter explains only"
            f" {1e3 * allowed:.2f} mm. With the implied diameter all moduli and stresses of this"
            f" specimen would be {_against(effect, 'higher', 'lower')}"
        ),
    ),
    "no-diameter": (
        "refusal",
        "no diameter or area is stated: spring constants are given, but no stress or modulus",
    ),
}  # fmt: skip

_OF_CYCLES: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "jumps-no-reversals": (
        "note",
        "{n_jumps} short spikes of the control channel are not counted as reversals, first at"
        " {time:g} s",
    ),
    "gaps-end-runs": (
        "note",
        "gaps in the record longer than 30 % of a half cycle: {n_gaps}, first near {time:g} s; no"
        " cycle extends across a gap",
    ),
    "cycles-by-turns": (
        "warning",
        "only {n_cycles} of about {n_moves} cycles, up to {time:g} s, are logged without gaps. All"
        " results are from these; cycles logged only by their peaks and valleys are not used",
    ),
    "cycles-of-two-amplitudes": (
        "note",
        "{n_cycles} transition cycles between two amplitudes or levels are not counted, first at"
        " {time:g} s",
    ),
    "cycles-of-other-length": (
        "note",
        lambda n_cycles, time: (
            f"{n_cycles} cycle{'s' * (n_cycles > 1)} differ{'s' * (n_cycles == 1)} in length from"
            f" the others, first at {time:g} s, and {'is' if n_cycles == 1 else 'are'} left out:"
            " the machine paused there, or its function generator was restarted"
        ),
    ),
    "cycles-of-starting-machine": (
        "note",
        lambda n_first, n_last: (
            "the machine was not at full amplitude in the "
            + " and the ".join(
                f"{end} cycle" if number == 1 else f"{end} {number} cycles"
                for end, number in (("first", n_first), ("last", n_last))
                if number
            )
            + ", left out here and counted only in slopes per decade of cycles"
        ),
    ),
    "counter-constant": (
        "note", "the machine's cycle counter never changes: reversals are counted instead",
    ),
    "cycles-in-gaps": (
        "note",
        "gaps in the log could hold {n_hidden} cycles in addition to the {n_cycles} logged: slopes"
        " per decade of cycles count them, and their uncertainty allows for the slopes without"
        " them. A cycle_counter in the layout settles this",
    ),
    "failed-in-gap": (
        "warning",
        "it failed between cycles {last} and {following}, and the cycles between them are not"
        " logged: the cycles to failure are those up to the first of these, a lower bound",
    ),
    "life-across-gaps": (
        "warning",
        "{n_hidden} of the cycles counted to failure are not in the log: its gaps could hold them,"
        " if the machine ran on. {n_cycles} are logged. Add the machine's cycle_counter to the"
        " layout",
    ),
    "counted-without-stroke": (
        "note", "{n_cycles} machine-counted cycles have no stroke, first machine cycle {first}",
    ),
    "stored-from-peak": (
        "warning",
        "the cycle_counter skips {n_cycles} times, and it counts at the peaks: a cycle that was"
        " stored alone has no complete loading or unloading branch, and is not used. Set the"
        " machine to count at the valleys, or store two cycles in a row",
    ),
    "counter-skips": (
        "note",
        "the log contains {n_cycles} of the machine cycles {first} to {last}: {after} follows"
        " {before}",
    ),
    "counter-differs": (
        "warning",
        "the machine counted {n_counted} cycles with a stroke, but the reversals give"
        " {n_reversals} complete cycles",
    ),
    "cycles-small": (
        "note",
        "the cycles have a range of {stroke:.4g} {unit} in a record of {of_record:.4g} {unit}; they"
        " were found with a band of {band:.3g} {unit}. State cycles.band to use another",
    ),
    "one-cycle": ("note", "one cycle only: no cycle-to-cycle scatter can be given"),
    "few-samples-a-cycle": (
        "warning",
        "{n_samples:g} samples per cycle; {needed} are needed for reliable peaks and loops. Peaks"
        " between samples are missed, which affects the spring constant, and tangent moduli may"
        " not be available. Log every {step}, or use the log before thinning",
    ),
    "few-samples-a-stroke": (
        "warning",
        "{n_samples:g} samples in the faster stroke; {needed} are needed for reliable peaks and"
        " loops. Peaks between samples are missed; whole cycles may be missed too. Log every"
        " {step}, or use the log before thinning",
    ),
    "cycles-not-as-planned": (
        "warning", "{n_found} complete cycles found, {n_planned} planned",
    ),
    "planned-cycles-not-whole": (
        "note",
        "{n_found} complete cycles found, {n_planned} planned: incomplete cycles at the beginning"
        " or the end of the cycling are not counted",
    ),
    "no-plateau": (
        "note",
        lambda waveform: (
            f"a {'sinusoidal' if waveform == 'sinusoidal' else 'non-triangular'} waveform has no"
            " part at constant rate: branches are trimmed by 5 % of the stroke at each end"
        ),
    ),
    "branches-without-constant-rate": (
        "note",
        "{n_bare} of {n_branches} branches have no part at a constant rate, first near {time:g} s",
    ),
    "strain-impossible": (
        "warning",
        "strain reaches {strain:.4g}, which is impossible. Check the unit of position and the"
        " reference length of strain",
    ),
    "cycles-drift": (
        "warning",
        "{n_far} of {n_cycles} cycles drift by more than {limit:.0%} of their range; the drift"
        " affects their amplitudes, slopes and energies",
    ),
    "sign-of-tension": (
        "warning",
        "tension falls with stretch (median tangent modulus {slope:.4g} Pa). If the log counts"
        " compression as positive, set sign = -1 for this channel; if it is set already, remove it",
    ),
    "loops-run-backward": (
        "warning",
        lambda slope, tension, strain, channel: (
            f"tension falls with stretch ({slope:.4g} N per unit strain, at a mean of {tension:.4g}"
            f" N and {100 * strain:.3g} %): "
            + (
                f"the sign of the {channel} channel is reversed; set sign = -1 for it in the layout"
                if channel
                else "the sign of one channel is reversed, or the log shows the inertia of moving"
                " parts; check sign and zero of both channels"
            )
            + ". Stiffness, loop energy and loss are not given"
        ),
    ),
    "period-changes": (
        "note",
        lambda share: (
            f"the period changes by {100 * share:+.2g} % from cycle to cycle, as in a sweep of"
            ' frequency: the loops are reduced as those of waveform = "other", since no single sine'
            " fits the cycles"
        ),
    ),
    "wave-not-periodic": (
        "warning",
        lambda share, is_open: (
            f"the wave does not repeat from cycle to cycle (it differs by {share:.0%} of"
            " half its range), as when two frequencies are combined or the amplitude jumps between"
            " cycles: a cycle is not a closed loop, and its stiffness does not belong to one"
            " frequency and amplitude"
            + (". Its energy and loss are not given" if is_open else "")
            + ". Test each frequency separately, and declare each amplitude as a step of its own"
        ),
    ),
    "changes-alone-logged": (
        "warning",
        "the log has no small steps and waits at its turns: the logger seems to store changes"
        " alone. Amplitudes may be up to {share:.1%} too small. Log at a constant rate",
    ),
    "wave-changes": (
        "warning",
        lambda share, last, first, begin: (
            f"the waveform changes between cycles {last} and {first} (cycle {first} begins at"
            f" {begin:.6g} s; the shapes differ by {share:.0%} of half the range): the means over"
            " the cycles belong to neither. Enter each part as a test with the same file, its own"
            " waveform and order, and one step"
        ),
    ),
    "zero-moves-at-stop": (
        "warning",
        lambda number, size, explained: (
            f"the mean tension is {abs(size):.3g} N {'higher' if size > 0 else 'lower'} after the"
            f" stop or gap after cycle {number} than before it, and stays so; relaxation may"
            f" explain {explained:.2g} N: the zero of the load cell has moved, or something"
            " slipped. The intervals of mean tensions include this; amplitudes and EA are not"
            " affected. Correct the log, or enter the cycles before and after it as steps"
        ),
    ),
    "tension-hums": (
        "warning",
        lambda frequency, size, effect: (
            f"tension oscillates at {frequency:.3g} Hz by {size:.3g} N on top of its wave (mains"
            f" hum or a vibration): its extremes are off by up to {effect:.1%} of the tension"
            " amplitude, and EA with them. Remove the cause, or filter both channels alike before"
            " the run"
        ),
    ),
    "loops-give-work": (
        "warning",
        lambda energy, n_cycles, n_known, delay, stated, time_step, cause: (
            f"{n_cycles} of {n_known} loops run the wrong way and give out energy ({energy:.4g} J/m"
            " on average). Tension rises with stretch, so no sign is reversed; it lags stretch by"
            f" {1e3 * delay:.3g} ms or more, "
            + {
                "lag": f"within the stated lag of {1e3 * stated:.3g} ms (k=1): tension was logged"
                " late, and the sign of the loss is not known",
                "sampling": f"less than the sampling interval of {1e3 * time_step:.3g} ms: the"
                " channels were not sampled simultaneously. State a lag",
                "driven": (
                    f"more than twice the stated lag of {1e3 * stated:.3g} ms: the specimen is"
                    " driven, or the lag is larger than stated"
                    if stated
                    else "and no lag is stated: tension was logged late by this time, or the"
                    " specimen is driven"
                ),
            }[cause]
        ),
    ),
    "loops-not-of-a-sine": (
        "warning",
        lambda share, effect: (
            "the waveform is stated as sinusoidal, but the loss computed from the fundamentals in"
            f" time would be {share:.3g} times the energy of the loops: the log is not sinusoidal"
            " (rise and fall of unequal duration?). Stiffness, loss and amplitudes are those at"
            " equal phase of the stroke, as for any other waveform"
        ),
    ),
    "loops-widen-evenly": (
        "warning",
        lambda change, rate, first, last, **_: (
            f"the hysteresis energy {'rises' if change > 0 else 'falls'} evenly from {first:.3g} to"
            f" {last:.3g} J/m over the test, while EA does not change. If load and position come"
            " from two loggers, their clocks drift apart by about"
            f" {float(f'{1e6 * abs(rate):.2g}'):g} ppm ({abs(change):.2g} s in all): log both on"
            " one clock. If not, the specimen heats up or wears, and the means over the cycles"
            " represent no single state"
        ),
    ),
    "drift-in-energy": (
        "warning",
        lambda energy, closed, effect: (
            f"the loop area as logged is {closed:.4g} J/m, of which {closed - energy:+.3g} J/m"
            f" ({effect:+.1%} of the result) is due to drift of the cycles: the hysteresis"
            f" energy of {energy:.4g} J/m excludes it"
        ),
    ),
    "slack-in-cycles": (
        "warning",
        "the specimen goes slack in {n_slack} of {n_cycles} cycles (tension at or below"
        " {slack_tension:.4g} N); their amplitudes and energies include the slack part. If it is"
        " taut at this load, state a lower phases.slack_tension. A load of exactly 0 in them may"
        " be cut off by a logger without negative readings: correct its zero and test again",
    ),
    "pushed-in-cycles": (
        "warning",
        "tension is negative in part of the cycles (down to {least:.4g} N, median): amplitudes and"
        ' energies include that part. If the specimen can carry compression, state kind = "other";'
        " if it cannot, the zero of the load is wrong",
    ),
    "no-snap-loads": (
        "note",
        "{n_taut} of {n_cycles} cycles are not snap loads: tension stays above"
        " {slack_tension:.4g} N, so the line does not go slack",
    ),
    "not-triangular": (
        "warning",
        "the waveform is taken as triangular (stated, or by default), but only {share:.0%} of the"
        ' branches run at a constant rate. Check whether waveform = "sinusoidal" applies',
    ),
    "stated-lag-long": (
        "warning",
        "the stated lag of {lag:.4g} s exceeds a twentieth of the period in {n_short} of"
        " {n_cycles} cycles (shortest {shortest:.4g} s): its effect on stiffness and loss is"
        " estimated to first order only, so their uncertainties are too small",
    ),
    "reading-error-not-used": (
        "note",
        "noise and resolution of {channel} stated in [uncertainty] ({stated:.3g} {unit} together)"
        " are not used: the layout declares standard_uncertainty, {declared:.3g} {unit}, for its"
        " readings",
    ),
    "inertia-taken-off": (
        "note",
        lambda mass, force, width, n_lost, cell: (
            f"tension is corrected for inertia: {mass:.4g} kg at the moving end, up to {force:.4g}"
            f" N at the load cell at the {cell} end; acceleration from position, in windows of"
            f" {width:.3g} s"
            + (
                f"; {n_lost} samples in cycles have no acceleration and so no tension"
                if n_lost else ""
            )
        ),
    ),
    "give-taken-off": (
        "note",
        "position is corrected for machine compliance: {compliance:.4g} m/N times the tension, up"
        " to {length:.4g} m",
    ),
    "attached-mass-unknown": ("note", _unknown_mass),
    "attached-mass-matters": ("warning", _unknown_mass),
    "inertia-left-at-turns": (
        "warning",
        lambda force, effect: (
            f"the inertia that is not corrected at the reversals is {force:.3g} N,"
            f" {effect:.1%} of the tension amplitude: the machine reverses faster than the"
            " log resolves. EA, energy and the moduli near the reversals may be off by this share."
            " Test with a sine, or with a load cell at the fixed end, or log faster"
        ),
    ),
    "specimen-near-resonance": (
        "warning",
        lambda share, effect: (
            f"the test ran at {share:.2g} of the resonance frequency of the specimen (from its"
            " stated mass), and higher at sharp reversals: waves run along it, and even after the"
            f" correction for its mass EA and energy may be off by {effect:.1%}. Test more"
            " slowly, or with a sine"
        ),
    ),
    "specimen-sags": (
        "warning",
        lambda effect, density, is_stated, length: (
            f"if the specimen of {length:.3g} m lay horizontally, its sag changed EA by"
            f" {100 * effect:+.2g} % ({density:.3g} kg/m,"
            f" {'as stated' if is_stated else 'usual for its break strength'}), which is not"
            " corrected. Support it, test at a higher tension or measure strain on the rope; if it"
            " hung, state vertical = true in the layout"
        ),
    ),
    "own-mass-unknown": (
        "note",
        "the inertia of the specimen itself is not corrected (this needs load_cell_at and"
        " linear_density): a specimen mass of {at_moving:.3g} kg would change EA by one standard"
        " uncertainty with the load cell at the moving end, {at_fixed:.3g} kg with the load cell"
        " at the fixed end",
    ),
    "compliance-unknown": ("note", _unknown_compliance),
    "instrument-hysteresis-unknown": ("note", _unknown_hysteresis),
    "lag-unknown": ("note", _unknown_lag),
    "lag-matters": ("warning", _unknown_lag),
    "compliance-matters": ("warning", _unknown_compliance),
    "tension-late": (
        "warning",
        lambda lag, spread, stated, is_of_stops: (
            f"tension {'stops' if is_of_stops else 'reverses'} {1e3 * lag:.0f} +-"
            f" {1e3 * spread:.0f} ms (k=1) after position, but"
            f" {f'a lag of 0 +- {1e3 * stated:g} ms is stated' if stated else 'no lag is stated'}."
            f" Damping makes tension {'stop' if is_of_stops else 'reverse'} before position, never"
            " after it: tension was delayed by at least this much, by the logger or a filter."
            " No correction is made: loop energy and loss are too small, and their intervals"
            " include this"
        ),
    ),
    "tension-filtered": (
        "warning",
        lambda lag, **_: (
            "the noise of the load shows that it was low-pass filtered, which delays it by about"
            f" {1e3 * lag:.0f} ms, and that position was not: filter both alike, or state the lag."
            " No correction is made: loop energy and loss are too small, and their intervals"
            " include this"
        ),
    ),
}  # fmt: skip

_OF_MODULI: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "break-in-left-out": ("note", "the first {n_cycles} cycles (break-in) are not averaged"),
    "no-tangent-modulus": (
        "refusal",
        "specimen {place} of the record has no tangent modulus: no window has enough samples",
    ),
    "cycles-aligned": (
        "note",
        "the mean strain of the cycles drifts by {drift:+.3%} from first to last ({effect:.0%} of"
        " the range of a cycle; {per_decade:+.3%} per decade of cycles): the cycles are shifted to"
        " a mean strain of {reference:.3%} before their curves are averaged",
    ),
    "outcome-far-off": (
        "warning",
        lambda quantity, row, ratio, n_others, like: (
            f"row {row}: its {quantity} is {ratio:.3g} times the median of the {n_others} others of"
            f" its group{f' (as {like})' if like else ''}. Check the value and its unit, or state"
            " valid = no"
        ),
    ),
    "stiffness-changes-at-cycle": (
        "warning",
        "the stiffness changes by {change:+.1%} after cycle {number}, and the mean level with it:"
        " part of the specimen may have parted (a strand, a layer of cords). The averages mix both"
        " states",
    ),
    "strain-jumps": (
        "warning",
        "the mean strain jumps by {size:+.3%} after cycle {number} ({effect:.0%} of the amplitude),"
        " and the tension does not follow: an extensometer, a grip or a splice has slipped. Mean"
        " strain and the position of every curve on the strain axis are off by up to this much;"
        " amplitudes and EA are not affected",
    ),
    "tension-jumps": (
        "warning",
        "the mean tension jumps by {size:+.4g} N after cycle {number} ({effect:.0%} of the"
        " amplitude), and the strain does not follow: a grip or a splice has slipped, a part of the"
        " specimen has failed, or the load cell was knocked. Mean tension and curves mix both"
        " states: reduce the cycles before and after the jump separately, as steps",
    ),
    "bins-of-some-cycles": (
        "refusal",
        "specimen {place} of the record: curves are given at {n_given} of {n_bins} strains (both"
        " branches together); fewer than {least:.0%} of the cycles reach the others, too few for a"
        " mean curve",
    ),
    "samples-off-grid": (
        "note",
        "{n_samples} samples lie outside the strain grid and are in no curve: their strain is"
        " beyond the reversals of all cycles",
    ),
    "identity-open": (
        "warning",
        lambda effect, error, is_coarse, of_lag, is_of_turns: (
            "the difference between the mean slopes of the two branches does not match the tension"
            f" lost over a cycle: residual {effect:+.1%} of the modulus (standard error"
            f" {_share(error)}). "
            + (f"The stated channel lag explains up to {of_lag:.1%} of it" if of_lag else
               "The readings at the reversals explain it: in all cycles the reversal lies between"
               " the same two readings" if is_of_turns else
               "Possible causes: channel lag, a dwell at the reversals, slip or slack"
               f"{', or too few samples for the curvature' if is_coarse else ''}")
        ),
    ),
    "slip-cycles-missing": (
        "note", "no search for slip: {n_missing} of {n_cycles} cycles are missing",
    ),
    "splice-slipped": (
        "warning",
        lambda cycles, length, excess, effect: (
            f"the splices slipped at {cycles}, by {_slip_in_words(length)} in all"
            + ("" if excess != excess else
               ": from there on, and in later tests without marks of their own, strain is at least"
               f" {100 * excess:.1f} percentage points too large ({effect:.1%} of the mean"
               " strain), and the intervals allow for three times that")
            + ". Read the marks after the test, or use the cycles before the slip"
        ),
    ),
    "splice-slipped-before": (
        "warning",
        lambda length, excess, effect: (
            f"before this test the splices slipped by {_slip_in_words(length)}, and no"
            " marks were read in it"
            + ("" if excess != excess else
               f": strain is at least {100 * excess:.1f} percentage points too large ({effect:.1%}"
               " of the mean strain), and the intervals allow for three times that")
            + ". Read marks in this test"
        ),
    ),
    "tension-steps-up": (
        "warning",
        "tension steps up at cycle {cycles}. A splice cannot do this: check the zero of the load"
        " cell and the set point of the crosshead",
    ),
    "specimens-step-together": (
        "warning",
        "two specimens step at cycle {cycle}: check the crosshead before the splices",
    ),
    "no-common-strain": ("refusal", "{above} and {below} have no common strain range"),
    "unequal-condition": ("note", "the conditions before the campaign differ: {told}"),
    "history-without-order": (
        "note", "the effect of earlier tests on either specimen is not known: no order is given",
    ),
    "history-with-failed-tests": (
        "note", "the effect of earlier tests is not fully known: one of them failed",
    ),
    "unequal-cycles": (
        "note",
        "different test histories: {cycles:.0f} earlier cycles against {of_first:.0f}",
    ),
    "unequal-flex-cycles": (
        "note", "different test histories: {told} earlier flex cycles",
    ),
    "unequal-strain": (
        "note", "different test histories: maximum earlier strain {told}{softer}",
    ),
    "law-not-fitted": ("refusal", "not fitted: {reason}"),
    "law-not-told-from-zero": ("note", "interval includes zero: {names}"),
    "law-not-stable": (
        "note",
        lambda strain: (
            f"the fitted law is not stable: below a strain of {100 * strain:.3g} % its stress falls"
            " with strain in uniaxial, biaxial or shear deformation. Do not use it in a model"
        ),
    ),
    "law-without-pull": (
        "refusal",
        "no hyperelastic law: the first rise of the record is not a pull from slack ({reached})."
        " Check the kind of the test, and the zero of strain",
    ),
    "no-law": ("refusal", "no hyperelastic law from the first loading: {reason}"),
    "law-of-softened-rubber": (
        "note",
        lambda strain: (
            f"not a first loading: earlier tests reached {strain:.0%} strain, and the"
            " rubber is softened below that (Mullins effect)"
            if strain == strain
            else "not a first loading: the strain reached in earlier tests is not known"
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
            f"the stated gauge length of {1e3 * stated:.1f} mm is not used: it would give strains"
            f" of {100 * low:.0f} to {100 * high:.0f} %, which the recorded elongations contradict"
        ),
    ),
    "length-error-from-scatter": (
        "note",
        lambda scatter: (
            "the uncertainty of the lengths is not stated; it is taken from the scatter between"
            f" length and recorded elongation, {1e3 * scatter:.2f} mm"
        ),
    ),
    "reading-inconsistent": (
        "warning",
        lambda length, strain, recorded, corrected, speaks_for, beside: (
            f"a length of {1e3 * length:.1f} mm gives {strain:.0%}, but {recorded:.0%} is recorded;"
            f" the row gives no modulus. A length of {1e3 * corrected:.1f} mm would"
            f" agree{f' (the eye-to-eye length supports the {speaks_for})' if speaks_for else ''},"
            " and the moduli of the adjacent intervals would be"
            f" {' and '.join(f'{one / 1e6:.2f}' for one in beside)} MPa"
        ),
    ),
    "reading-of-creep": (
        "warning",
        lambda elapsed, weight, growth: (
            f"in {elapsed / 60:.0f} min the weight changed by {weight:+.1f} N and the length by"
            f" {1e3 * growth:+.1f} mm: this is creep, not elastic strain"
        ),
    ),
    "reading-again": (
        "note",
        lambda elapsed, growth: (
            f"read again after {elapsed / 60:.0f} min under the same weight: {1e3 * growth:+.1f} mm"
        ),
    ),
    "reading-of-odd-weight": (
        "warning",
        "a weight of {weight:.5g} N is far from those before and after it, but the length is in"
        " line with its neighbours; the row gives no modulus. Check the weight",
    ),
    "reading-of-odd-length": (
        "warning",
        lambda length, expected: (
            f"a length of {1e3 * length:.1f} mm is {abs(1e3 * (length - expected)):.0f} mm"
            f" {'more' if length > expected else 'less'} than the readings beside it suggest; the"
            " row gives no modulus. Check the weight and the length"
        ),
    ),
    "one-slope-of-weights": (
        "refusal",
        "no modulus given: a single slope between two readings does not show the modulus at a given"
        " strain. Read the length under at least three weights",
    ),
}  # fmt: skip

_OF_HOLDS: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "no-hold": (
        "refusal",
        lambda slack_tension, channel, tolerance, unit, duration, key: (
            f"no hold found: above the slack tension of {slack_tension:.3g} N {channel} never stays"
            f" within {tolerance:.3g} {unit} for {duration:g} s. Check kind and control, or state"
            f" phases.{key}"
        ),
    ),
    "hold-samples-left-out": ("note", "{n_left_out} of {n_samples} samples are not used"),
    "hold-empty": ("refusal", "nothing given: {n_samples} usable samples in the hold"),
    "hold-too-short": (
        "refusal",
        "drop, rate per decade and Prony series not given: the hold is too short, {duration:.3g}"
        " s; it needs {needed:g} s or more",
    ),
    "hold-too-few-samples": (
        "refusal",
        "drop, rate per decade and Prony series not given: too few samples, {n_samples}; {needed}"
        " are needed",
    ),
    "hold-slack": (
        "refusal",
        "drop, rate per decade and Prony series not given: the specimen is slack at {tension:.3g}"
        " N; more than {slack_tension:.3g} N is needed",
    ),
    "hold-tension-rises": (
        "refusal",
        "drop, rate per decade and Prony series not given: tension rises by {rise:.2%} over the"
        " hold (recovery after unloading, or drift)",
    ),
    "hold-crosshead-moves": (
        "refusal",
        lambda motion, worth: (
            f"drop, rate per decade and Prony series not given: the crosshead moves by {motion:.2g}"
            f" m in the hold{f', equivalent to {worth:.3g} N' if worth == worth else ''}."
            ' If the machine held the load, state kind = "creep"'
        ),
    ),
    "hold-settles": (
        "warning",
        "the crosshead moves by a further {motion:.2g} m after the ramp, equivalent to"
        " {worth:.3g} N ({share:.1%} of the loss): drop, rate per decade and Prony series refer to"
        " the length at the end of the ramp; their uncertainty allows for half of this change",
    ),
    "hold-ramp-within-steps": (
        "warning",
        "the ramp takes at most two steps of the log, so the relaxation between its end and the"
        " first reading of the hold was not logged. The uncertainties of initial tension and drop"
        " allow for the loss in a decade of time. Log faster",
    ),
    "hold-start-contradicted": (
        "refusal",
        "drop, rate per decade and Prony series not given: the log peaks at {peak:.4g} N near the"
        " end of the ramp, where the tension is {initial:.4g} N; the start of the hold is unclear",
    ),
    "hold-load-late": (
        "warning",
        lambda rise, peak, delay, is_refused: (
            ("initial tension, drop, rate per decade and Prony series not given: " * is_refused)
            + f"the load rises by {rise:.3g} N to {peak:.4g} N within {delay:.2g} s after the"
            " crosshead has stopped, although a specimen held at one length relaxes: the load lags"
            " (a filter, a slow load cell or another clock)"
            + (
                "; remove the filter, or pull more slowly"
                if is_refused
                else ". The uncertainty of initial tension and drop includes twice that rise"
            )
        ),
    ),
    "hold-begins-with-jerk": (
        "warning",
        "tension dips from {before:.4g} to {lowest:.4g} N as the crosshead stops, and oscillates:"
        " the crosshead stops abruptly, and the mass between specimen and load cell vibrates. The"
        " first {settled:.2g} s are not used. The initial tension is that before the dip; its"
        " uncertainty allows for {after:.4g} N, extrapolated back from the readings after the"
        " oscillation",
    ),
    "prony-misses-ramp-end": (
        "refusal",
        "Prony series not given: it yields {modelled:.4g} N at the end of the ramp, where the log"
        " has {initial:.4g} N +- {spread:.2g} N (one standard uncertainty)",
    ),
    "hold-tension-steps": (
        "refusal",
        "drop, rate per decade and Prony series not given: tension steps by {step:.3g} N at"
        " {time:.0f} s into the hold, which relaxation does not explain (possibly a splice slip)",
    ),
    "rate-without-ramp": (
        "refusal",
        "rate per decade not given: the record does not show the ramp, so the time since loading"
        " is not known",
    ),
    "no-rate": ("refusal", "rate per decade not given: {reason}"),
    "rate-not-told-from-zero": (
        "refusal",
        "rate per decade not given: the loss per decade, {loss:.2%}, is less than three times its"
        " standard uncertainty, {spread:.2%}",
    ),
    "drop-not-told-from-zero": (
        "refusal",
        "Prony series not given: the drop, {drop:.2%}, is less than three times its standard"
        " uncertainty, {spread:.2%}",
    ),
    "no-prony-series": ("refusal", "Prony series not given: {reason} ({found})"),
}  # fmt: skip

_OF_LINE: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "no-slow-pull": ("refusal", "specimen {place} has no {lacking}"),
    "mean-tension-outside-pull": (
        "warning",
        "the mean tension of {mean:.4g} N is outside the range of the slow pull {pull}, {low:.4g}"
        " to {high:.4g} N",
    ),
    "bent-loops": (
        "note",
        "the loops are curved like the slow pull: K_0 is that of the pull over the cycle, around"
        " {at:.4g} N (the tension of their midline at the mean strain), not its slope at the mean"
        " of peak and valley, {mean:.4g} N ({effect:+.1%})",
    ),
    "mean-tension-drifts": (
        "warning",
        "the mean tension drifts from {first:.4g} to {last:.4g} N over the run, which changes K_0"
        " by {effect:+.0%}; K_0 is that at {mean:.4g} N",
    ),
    "loops-no-ellipses": (
        "warning",
        "the loops are not elliptical: E'' from loop area is {ratio:.2f} times E'' of the"
        " fundamental. K_1 and tau from the fundamental are more reliable",
    ),
    "line-uncertainty-skewed": (
        "warning",
        "in {n_skewed} of {n_lines} cases the uncertainty of K_0 exceeds {limit:.0%} of K_1: the"
        " standard uncertainties of K_1 and tau are not reliable",
    ),
    "line-slack-in-loops": (
        "warning",
        "the spring-dashpot model does not apply to {n_slack} of {n_loops} loops, in which the line"
        " goes slack",
    ),
    "no-line": ("refusal", "K_1 and tau not given in {n_lines} of {n_all} cases: {reason}"),
    "line-by-monte-carlo": (
        "note",
        "K_1 and tau: uncertainty and 95 % interval are by Monte Carlo, since linear propagation"
        " fails: the linear uncertainty of {worst} is {ratio:.2f} times that of Monte Carlo",
    ),
    "line-draws-without-solution": (
        "note",
        "K_1 and tau: uncertainty and 95 % interval are by Monte Carlo, since linear propagation"
        " fails: a fraction of {share:.2g} of the draws of loop and slow pull has no K_1 and tau;"
        " the interval is from the other draws",
    ),
    "no-pull": ("refusal", "quasi-static spring constant not given: {reason}"),
    "pull-misfit": (
        "note",
        "a cubic misses the load-strain curve by {misfit:.1%} of its strain (rms). Do not use its"
        " coefficients for design; strain and K_0 are those of a spline and are not off by that",
    ),
    "pull-falls": (
        "warning",
        "tension falls on the way to the peak, by {fall:.1%} of the rise, as when a line relaxes in"
        " a hold or a strand parts: K_0 near these tensions belongs neither to the pull nor to the"
        " hold. Use the static stiffness between holds, or declare a part without holds as a step"
        " with its own from and to",
    ),
    "pull-creeps": (
        "warning",
        "strain grows at constant tension on the way to the peak, by {share:.1%} of the strain of"
        " the pull: K_0 near these holds belongs neither to the pull nor to the hold. Use the"
        " static stiffness between holds, or declare a part without holds as a step with its own"
        " from and to",
    ),
    "pull-rate-uneven": (
        "note",
        "the strain rate varies from {low:.2g} to {high:.2g} 1/s between quarters of the range",
    ),
    "pull-not-slow": (
        "warning",
        "the slow pull is too fast for the relaxation time of the loops: K_0 is wrong by up to"
        " {effect:.1%}, and K_1 and tau with it. Their intervals include it. Pull more slowly",
    ),
    "pull-rate-matters": (
        "note",
        "K_0 applies at the rate of the slow pull: if K_1 and tau of the loops apply there too, it"
        " differs by {effect:.1%} from K_0 of an infinitely slow pull",
    ),
    "pull-length-not-stated": ("note", "the length at which strain is zero is not stated"),
    "pull-off-zero": (
        "note",
        "strain is {strain:+.2%} at the reference tension: the reference length was read at"
        " another tension, or the line has lengthened since",
    ),
    "pull-waiting-not-stated": (
        "note", "the time since the last dynamic test is not stated, but K_0 depends on it",
    ),
    "pull-cut-at-turn": (
        "note", "the usable range ends where strain does not rise with tension",
    ),
    "level-with-few-cycles": (
        "note", "level {level} has {n_cycles} of the {n_asked} requested cycles",
    ),
    "stiffness-of-few-cycles": (
        "note",
        "dynamic stiffness is from {n_cycles} cycles; rope.last_cycles is {n_asked}",
    ),
    "stiffness-not-settled": (
        "warning",
        "the dynamic stiffness has not settled: it changes by {effect:+.1%} over the last"
        " {n_cycles} cycles. Run more cycles",
    ),
    "cycles-of-another-level": (
        "note",
        "{n_other} of {n_cycles} cycles are at another level than the last ones, which give the"
        " dynamic stiffness. Declare each level as a step",
    ),
    "no-bedding-in": ("refusal", "bedding-in not given: only one cycle; two are needed"),
    "first-cycle-begins-elsewhere": (
        "note",
        "the first cycle starts at {first:.4g} N, the others at {usual:.4g} N: its stiffness and"
        " the permanent strain include that part of the rise",
    ),
    "cycles-counted-until": ("note", "{how}"),
    "no-static-stiffness": ("refusal", "static stiffness not given: {reason}"),
    "no-static-slope": (
        "refusal",
        "change of the static stiffness per decade of time not given: the readings of the upper"
        " hold after 3 ramp times span {span:.2f} decades; {needed:g} are needed",
    ),
    "stiffness-amid-ramp-times": (
        "note",
        "the stiffness at {reference:g} s is the secant logged at that time, less than 3 times the"
        " ramp of {ramp:.3g} s: it applies only to a ramp of this length",
    ),
    "stiffness-beyond-hold": (
        "warning",
        "the stiffness at {reference:g} s is extrapolated; the hold has readings from {first:.3g}"
        " to {last:.3g} s",
    ),
    "no-break": (
        "refusal",
        "tensile strength not given: {how}: the line carried {tension:.4g} N or more",
    ),
    "pushed-in-pull": (
        "warning",
        "the load falls to {least:.4g} N and rises to {most:.4g} N only: the specimen is pushed,"
        " and load and strain of this pull are not its strength. For a test in compression, set"
        " sign = -1 for the load, and for a position that falls with it",
    ),
    "no-strain-at-failure": (
        "refusal",
        "strain at the greatest load not given: it is not known, or did not grow while the load"
        " rose to it: an extensometer was taken off, or the position counts the other way"
        " (sign = -1)",
    ),
    "no-break-strength": (
        "note", "no rated break strength is stated: results relative to it are not given",
    ),
    "no-order": (
        "note",
        "no test order is given for {specimens}: the effect of earlier tests is not known. Set"
        " order",
    ),
    "cycles-in-no-log": (
        "note",
        "{n_cycles} earlier cycles were not logged: earlier_maximum_strain and"
        " earlier_maximum_tension include only the logged tests",
    ),
    "after-a-greater-load": (
        "note",
        lambda test, earlier, tension: (
            f"test {test} loaded the specimen to {_newtons(earlier)} before; this test reaches"
            f" {_newtons(tension)}: its results apply only after the higher load"
        ),
    ),
    "earlier-test-failed": (
        "note",
        "earlier test {test} failed: its effect on {specimens} is not known, so earlier_cycles,"
        " earlier_maximum_strain and earlier_maximum_tension are missing",
    ),
    "earlier-test-without-strain": (
        "note",
        "earlier test {test} has no strain for {specimens}: earlier_maximum_strain is missing",
    ),
}  # fmt: skip

_OF_EXPERIMENTS: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "run-test-failed": ("warning", "its test failed"),
    "run-without-product": ("warning", "its test gave no results"),
    "run-without-line": ("refusal", "K_1 and tau not given: {reason}"),
    "run-slack": ("warning", "the line goes slack in {cycles}"),
    "same-log": (
        "warning",
        "{tests} have the same log, byte for byte. Check whether one run was copied under another"
        " name",
    ),
    "levels-off-plan": (
        "warning",
        "levels reached differ from the plan by more than {limit:g} coded: {where}; the surfaces"
        " use the levels reached",
    ),
    "screening-levels-off-plan": (
        "warning",
        "levels reached differ from the plan by more than {limit:g} coded: {where}; the effects"
        " use the planned levels",
    ),
    "no-main-part": ("refusal", "{part} not given: {reason}"),
    "no-surface": (
        "refusal",
        "surface of {responses} not given: {reason} ({n_runs} of {n_all} runs, {n_terms}"
        " terms){causes}",
    ),
    "no-effect": (
        "refusal",
        lambda responses, reason, without: (
            f"effects on {responses} not given:"
            f" {reason}{f'; no value of {without}' if without else ''}"
        ),
    ),
    "error-by-lenth": (
        "note",
        "no columns dummy_1, ..: the error is Lenth's estimate from the smaller effects",
    ),
    "effects-over-blocks": (
        "note", "the effects pool all blocks; differences between blocks are part of their error",
    ),
    "scale-by-runs": (
        "note",
        "{response} uses the surface fitted to {scale}: the runs scatter {ratio:.3g} times as much"
        " about {about} (p = {p:.2g})",
    ),
    "scale-rejected": (
        "note",
        "{response}: the runs scatter {ratio:.3g} times as much about this surface as about that of"
        " {scale} (p = {p:.2g}): its intervals are wider than necessary. State"
        ' transform = "{key}" for it in SPEC.toml',
    ),
    "slow-pull-error-shared": (
        "note",
        "t and p of the surfaces of K_1 and tau reflect only the scatter of the runs; the error of"
        " K_0, common to all runs of one slow pull, is in the uncertainty of the coefficients",
    ),
    "no-stiffness-forms": (
        "refusal", "stiffness forms of mooring codes not given: {reason}",
    ),
    "stiffness-forms-pooled": (
        "note",
        "stiffness forms of mooring codes pool the specimens: differences between specimens are"
        " part of their scatter",
    ),
    "no-derived-line": (
        "refusal", "K_1 and tau from surfaces of E' and E'' not given: {reason}",
    ),
    "no-check-of-single-time": (
        "refusal", "check of a single relaxation time not given: {reason}",
    ),
    "single-time": ("note", "{verdict}"),
    "runs-without-value": ("note", "runs without any value: {runs}"),
    "responses-miss-runs": ("note", "responses missing in further runs: {responses}"),
    "surface-not-fitted": ("refusal", "{responses}: {reason}"),
    "surface-not-judged": ("note", "{responses}: {reason}"),
    "runs-alike": (
        "warning",
        "runs {first} and {second} agree in every level and response ({n_pairs} such pairs). Check"
        " whether they are repeats or one run entered twice",
    ),
    "repeats-differ": (
        "note",
        "repeated runs differ by up to {spread:.2g} in coded levels (tolerance {tolerance:g}):"
        " pure error is computed after correcting them to common levels with the surface",
    ),
    "levels-off-range": (
        "note", "levels of {factor} {how} the plan: {low:.2f} to {high:.2f} coded",
    ),
    "runs-fix-terms": (
        "note", "runs that alone determine a term (leverage 1), without a residual: {runs}",
    ),
    "terms-lean": (
        "note",
        "terms are correlated: condition number {condition:.0f}; an exact Box-Behnken design of"
        " fifteen runs has 4.24",
    ),
    "blocks-fixed": (
        "note",
        "{n_specimens} specimens as fixed blocks: all terms are tested against the residuals, which"
        " include differences between specimens in their response to the factors; the mean applies"
        " to these specimens only",
    ),
    "specimens-pulled-together": (
        "note",
        "specimens were pulled together, so that errors of a pull are common to them: surfaces are"
        " judged by the scatter of the means of the pulls ({freedom} degrees of freedom)",
    ),
    "blocks-random": (
        "note",
        "{n_specimens} specimens as random blocks (REML): the mean is tested against the scatter"
        " between specimens ({freedom} degrees of freedom), the other terms against the residuals"
        " within; r2, analysis of variance, lack of fit and residuals are for fixed blocks",
    ),
    "surface-below-zero": (
        "warning",
        "the surface of {response} falls below zero within the levels, although no run does. Set"
        ' transform = "log"',
    ),
    "run-off-the-others": (
        "warning",
        lambda runs, responses, p, n_runs: (
            f"run {runs} is off the surface of the other runs in {responses} (p {p:.1g}). Check its"
            " log, load and levels, or repeat it"
            + (
                f"; the residuals do not show which of the {n_runs} is wrong" if n_runs > 1 else ""
            )
        ),
    ),
    "response-drifts": (
        "warning",
        "{response} drifts with run order: its residuals change by {slope:+.3g} per run,"
        " {share:+.2%} of the response (p {p:.2g})",
    ),
}  # fmt: skip

_OF_HOSES: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "layer-stretched": (
        "warning",
        lambda layer, strain, limit, angle: (
            f"layer {layer} is stretched by {strain:.1%} at the working load, above its"
            f" limit of {100 * limit:g} %: use a wrap angle of {degrees(angle):.1f} degrees or more"
        ),
    ),
    "layer-compressed": (
        "warning",
        lambda layer, strain, limit, angle: (
            f"layer {layer} is compressed by {-100 * strain:.1f} % below the working load, above"
            f" its limit of {100 * limit:g} %: use a wrap angle of {degrees(angle):.1f} degrees or"
            " less"
        ),
    ),
    "layer-without-angle": (
        "warning",
        "layer {layer}: no wrap angle keeps it within both limits up to the working load",
    ),
    "no-slack-zone": (
        "note",
        lambda angle: (
            f"at {degrees(angle):.2f} degrees there is no slack zone: the cords carry load from the"
            " start"
        ),
    ),
    "cords-touch": (
        "warning",
        "neighbouring cords touch {where} % strain: the prediction is not valid there",
    ),
    "bore-too-small": (
        "warning",
        "the bore is below its limit {where} % strain: the prediction is not valid there",
    ),
    "cords-broken": (
        "refusal",
        lambda strain: f"the cords are broken from {strain:.1%} strain on: no load given",
    ),
    "hose-without-uncertainty": (
        "note", "no uncertainty is stated for the hose: the prediction has none",
    ),
    "working-load-uncertain": (
        "warning",
        lambda effect: f"the safe working load is uncertain by {effect:.0%} (k = 1)",
    ),
    "layers-unbalanced": (
        "note",
        "the layers do not balance: {effect:.0%} of their torque is left, and a cable that is free"
        " to turn stretches further",
    ),
    "wire-outside-band": (
        "warning",
        lambda what, value, low, high: (
            f"its {what} is {value / 1e9:.3g} GPa, that of wires is {low / 1e9:g} to"
            f" {high / 1e9:g} GPa: check its unit"
        ),
    ),
    "wave-number-outside-band": (
        "warning",
        lambda name, value, low, high, unit: (
            f"{name} is {value:.4g}{unit}, not between {low:g} and {high:g}: check its unit"
            + (" and that it is 1 + C_m, not C_m" if name == "inertia_coefficient" else "")
        ),
    ),
    "wave-length-not-of-period": (
        "warning",
        "a wave of {period:.4g} s is {own:.4g} m long, not {stated:.4g} m: check wave_period,"
        " wave_length and water_depth",
    ),
    "wires-leave-core": ("warning", "the wires leave the core: none of these theories holds"),
    "wires-yield": ("warning", "the wires yield; all loads beyond that are too high"),
    "wave-breaks": ("warning", "the wave breaks: {ratio:.2f} of the breaking height"),
    "no-theory-at-depth": (
        "note", "Table 1 names no theory for a depth of {depth:.3f} wave lengths"
    ),
    "second-harmonic": (
        "note", "the second harmonic of the surface is {share:.0%} of the first"
    ),
    "stokes-at-its-end": (
        "note",
        "Stokes' second order is at its limit: Ursell number {ursell:.1f} (at most {most:.1f}),"
        " second harmonic of the surface {share:.0%} (at most {most_share:.0%})",
    ),
    "wave-length-off": (
        "note", "the stated wave length differs by {off:+.1%} from that of the period",
    ),
    "hose-scatters-wave": (
        "warning",
        "the diameter is {share:.0%} of the wave length: the hose scatters the wave, and Morison's"
        " equation does not hold above {most:.0%}",
    ),
    "high-wave-is-longer": (
        "note", "the wave by {theory} is {length:.4g} m long, because it is high",
    ),
    "theory-asked-for": (
        "note", "computed by {theory}, as stated; Zhang (2015) takes {usual} at this depth"
    ),
    "theory-error-unknown": (
        "warning", "the stream function finds no such wave: the error of {theory} is not known"
    ),
    "theory-does-not-hold": (
        "warning",
        "{theory} does not hold for this wave: the {errors}."
        ' Use wave_theory = "stream function"',
    ),
    "cycles-pooled": ("note", "each row pools {n_cycles} consecutive cycles"),
    "one-branch": (
        "note",
        "only one branch was measured and is compared itself; it lies above the midline by half the"
        " loop",
    ),
    "numbers-not-told-apart": (
        "warning",
        lambda names, words, needed: (
            f"this curve cannot separate {names}: {words}, less than a model error of"
            f" {100 * needed:.2g} %. The fitted values are one of many possible sets; their"
            " intervals include such a model error"
        ),
    ),
    "number-not-shown": (
        "warning",
        lambda names, words, needed: (
            f"this curve does not determine {names}: {words}, less than a model error of"
            f" {100 * needed:.2g} %"
        ),
    ),
    "number-at-bound": (
        "warning", "the fit of {name} stopped at a bound: its interval is not valid",
    ),
    "number-not-determined": (
        "warning",
        "{name} is not determined: its interval is wider than half the range allowed in the fit",
    ),
    "residuals-are-model": (
        "note",
        "the residuals contain {n_points:.1f} independent points for {n_numbers} parameters: they"
        " show a model error, not noise",
    ),
    "source-far-off": (
        "note", "{name} would have to be off by {factor:+.1f} times its standard uncertainty",
    ),
    "fitted-cords-broken": (
        "warning",
        "cords of the fitted hose are broken at {n_strains} of the measured strains; its tangent"
        " was compared there",
    ),
    "number-moved-far": (
        "note", "{name} moved by {factor:+.1f} times its stated standard uncertainty",
    ),
    "pick-up-not-shown": (
        "refusal", "cord pick-up is not visible in the test: {reason}",
    ),
    "dynamic-test": (
        "note",
        "the test is dynamic, the cord curve static. Nylon is stiffer under fast loading, so the"
        " prediction should stretch more than the test; not all of the difference is model error",
    ),
    "test-beyond-break": (
        "warning",
        "the test reached strain {strain:.4g}, but cord break is predicted for {n_broken} of its"
        " {n_strains} strains; these are not compared",
    ),
    "curve-ends-early": (
        "note",
        "the measured curve ends at strain {strain:.4g}, before the predicted working load",
    ),
    "stretch-beside-reported": ("note", "{side} {words}"),
    "prediction-counts-as-exact": (
        "note",
        "no uncertainty of the prediction is stated that acts at these strains: it is treated as"
        " exact, and an error of the angle or the cord curve counts as a model error",
    ),
    "test-counts-as-unbiased": (
        "note", "no calibration uncertainty is stated: the test is treated as unbiased",
    ),
    "load-cell-counts-as-exact": (
        "note", "no load cell uncertainty is stated: its gain and zero are treated as exact",
    ),
    "pressure-gauge-counts-as-exact": (
        "note", "no standard_uncertainty is stated for the fill_pressure channel: its zero is "
        "treated as exact",
    ),
    "shape-differs": (
        "warning",
        "no single strain differs by more than U, but the shape of the difference has a probability"
        " of only {probability} under the stated errors",
    ),
    "difference-without-error": (
        "warning",
        lambda effect: (
            f"{100 * effect:.2g} % of the squared difference cannot come from any stated error"
        ),
    ),
    "taken-as-dynamic": (
        "note", 'treated as dynamic, like all {kind} tests. For a slow test set loading = "static"',
    ),
    "from-stored-samples": (
        "note", "computed from the stored samples of a long record: {samples}",
    ),
    "no-curve-of-errors": (
        "note",
        "the archive of the test has no curve with instrument errors (none exists without a"
        " diameter): of the stated errors only the scales of load and strain and the zero of the"
        " load are in the comparison",
    ),
}  # fmt: skip

_OF_PLAUSIBILITY: dict[str, tuple[Severity, str | Callable[..., str]]] = {
    "modulus-outside-band": (
        "warning",
        lambda modulus, low, high, of, readings: (
            f"maximum stress over maximum strain is {_pascals(modulus)}; for {_one(of)} it is"
            f" between {_pascals(low)} and {_pascals(high)}. Check the unit of load, the"
            f" diameter, the gauge length and the material.{_would_fit(readings)}"
        ),
    ),
    "load-never-falls": (
        "warning",
        "tension stays at its greatest value while the crosshead comes back: the amplifier or the"
        " display holds the peak. Log the load itself",
    ),
    "load-in-steps": (
        "warning",
        "tension was logged in steps of {step:.3g} N, {share:.1%} of its greatest value: the"
        " resolution or the range of the amplifier is too coarse, or the log was rounded. This"
        " limits the accuracy of moduli and energies",
    ),
    "spikes-not-resampled": (
        "warning",
        lambda n_samples, channel, time: (
            f"single readings of {channel} jump away and back at once ({n_samples}, first at"
            f" {time:.6g} s): they are not used, and nothing is interpolated beside them. Where"
            " they are sound, raise reduction.quality.spike_factor"
        ),
    ),
    "extensometer-drops-out": (
        "note",
        "{n_samples} readings of the extensometer jump away and back at once and are not used. If"
        " it writes a fixed value where it loses its target, declare that as a missing mark in the"
        " layout",
    ),
    "extensometer-late": (
        "warning",
        "the extensometer lags the crosshead by {step:.3g} s, as a camera does, more than the"
        " damping of the specimen explains: it widens the loops. The interval includes it as a lag;"
        " correct the time stamps of the channel (time_column)",
    ),
    "extensometer-ends": (
        "warning",
        "the measured strain stays at its greatest value for {n_samples} samples while the"
        " crosshead moves: the extensometer is at the end of its range, and strain amplitudes are"
        " too small",
    ),
    "position-ends": (
        "warning",
        "the position stays at its greatest or least value for {n_samples} samples while the load"
        " changes further and returns: the sensor is at the end of its range, strain amplitudes are"
        " too small and EA is too large",
    ),
    "mean-tension-ramps": (
        "warning",
        lambda first, last, is_of_load, grows: (
            f"the mean tension {'falls' if last < first else 'rises'} steadily from {first:.4g} to"
            f" {last:.4g} N over the cycles, "
            + (
                f"and the amplitude of tension {'grows' if grows > 0 else 'falls'} by"
                f" {abs(grows):.4g} N with it: the cycles are not at one level."
                if grows
                else "although the machine controls the load"
                if is_of_load
                else "and the middle of the stroke with it"
            )
            + (
                ""
                if grows
                else ": the machine did not hold the level (a leaking accumulator, a drifting set"
                " point)."
            )
            + " Every result of this test is a mean over these levels"
        ),
    ),
    "zero-or-relaxation": (
        "note",
        lambda earlier, later: (
            f"mean tension of cycles at the same strain goes from {earlier:.3g} to {later:.3g} N, "
            + (
                "as fast at the end as before: the specimen relaxes slowly"
                if later < earlier
                else "although relaxation would lower it: the specimen recovers, warms up or seats,"
            )
            + " or the zero of the load cell drifts. The log has no slack rest after the cycles"
            " that would show which"
        ),
    ),
    "strength-outside-band": (
        "warning",
        lambda found, low, high, of, readings: (
            f"rated_break_strength over the area of the diameter is {_pascals(found)}; for"
            f" {_one(of)} it is between {_pascals(low)} and {_pascals(high)}. Check the diameter,"
            f" the strength, its unit and the material.{_would_fit(readings)}"
        ),
    ),
    "density-outside-band": (
        "warning",
        lambda found, low, high, of, readings: (
            f"linear_density over the area of the diameter is {found:.3g} kg/m3; for {_one(of)} it"
            f" is between {low:.3g} and {high:.3g}. Check the unit of linear_density, the diameter"
            " and the material"
        ),
    ),
    "strain-above-band": (
        "warning",
        lambda strain, limit, of: (
            f"strain reaches {100 * strain:.3g} %, but {_one(of)} breaks below {100 * limit:.3g} %."
            " Check the gauge length, the unit of position or of the extensometer, and the material"
        ),
    ),
    "tension-above-strength": (
        "warning",
        lambda share: (
            f"tension reaches {share:.0%} of the rated_break_strength, but the test is not marked"
            " as failed. Check the unit and the gain of the load, and the rated_break_strength"
        ),
    ),
    "tension-far-below-strength": (
        "warning",
        lambda share: (
            f"tension reaches only {100 * share:.2g} % of the rated_break_strength. Check the unit"
            " and the factor of the load, and the unit of the rated_break_strength"
        ),
    ),
    "stretched-diameters-apart": (
        "warning",
        lambda least, greatest, swapped: (
            "at constant volume (as rubber deforms) the diameters read on the stretched specimen"
            f" imply different diameters before stretch, {1e3 * least:.4g} to {1e3 * greatest:.4g}"
            " mm. Check these diameters and the stretch at which each was read"
            + (f"; they agree if those at {swapped} are swapped" if swapped else "")
        ),
    ),
    "diameter-readings-apart": (
        "warning",
        lambda least, greatest: (
            f"readings of the diameter range from {1e3 * least:.4g} to {1e3 * greatest:.4g} mm."
            " Check them for an error"
        ),
    ),
    "faster-than-machines": (
        "warning",
        "the crosshead moves at {speed:.3g} m/s, faster than any test machine. Check the unit of"
        " time (a date of a spreadsheet counts days), the sampling interval and the unit of"
        " position",
    ),
    "rate-not-as-stated": (
        "warning",
        lambda stated, found, unit, ratio, like: (
            f"the log shows a rate of {found:.3g} {unit}, {ratio:.3g} times the stated rate of"
            f" {stated}{_is_like(like)}. Check the unit of time, the sampling interval, the unit of"
            " position and the rate"
        ),
    ),
    "slower-than-machines": (
        "warning",
        lambda period: (
            f"a cycle takes {period / 3600:.3g} h (in ms: {period / 1000:.3g} s). Check the unit of"
            " time and the sampling interval; if they are right, state frequency"
        ),
    ),
    "target-strain-missed": (
        "warning",
        lambda reached, target, ratio, like, method: (
            f"strain reaches {100 * reached:.3g} %, {ratio:.3g} times the target_strain of"
            f" {100 * target:.3g} %{_is_like(like)}. Check "
            + (
                "that the gauge length is the free length between the splices (not eye to eye), and"
                " its unit"
                if method == "gauge-length"
                else "the unit of the extensometer"
                if method == "extensometer"
                else "the unit of position and of the marks, that the row slack was read at slack,"
                " and the target_strain"
            )
        ),
    ),
    "lower-target-missed": (
        "warning",
        lambda reached, target: (
            f"the cycles go down to a strain of {100 * reached:.3g} %; the lower target_strain is"
            f" {100 * target:.3g} %. Check the target_strain, the zero of position and, with marks,"
            " that the row slack was read at slack"
        ),
    ),
    "level-not-as-stated": (
        "warning",
        lambda level, stated, found, unit, ratio, like: (
            f"the log shows a {level} of {found:.4g} {unit}, {ratio:.3g} times the stated {level}"
            f" of {stated}{_is_like(like)}. Check its unit and that of the log"
        ),
    ),
    "cycles-in-other-kind": (
        "warning",
        "the log contains about {n_cycles} cycles, but its kind is {kind}. Check the kind",
    ),
    "hold-of-position": (
        "warning",
        lambda at_stop, held, kind: (
            f"the crosshead stands still while the tension goes from {at_stop:.4g} N to the"
            f" {held:.4g} N of the hold: the machine held the position, not the load. "
            + ('State kind = "relaxation"' if kind == "creep" else "Check control")
        ),
    ),
    "break-in-is-all": (
        "warning",
        "break_in_cycles is {break_in}, but the log has only {n_cycles} cycles: none is left",
    ),
    "pull-below-runs": (
        "warning",
        "the slow pull ends at {reached:.4g} N, below the mean tension of every run (lowest"
        " {least:.4g} N): K_0 is not known at the runs",
    ),
    "hose-unlike-design": (
        "warning",
        lambda hose, ratio, low, high, like, readings: (
            f"between {100 * low:.3g} and {100 * high:.3g} % strain its tension is on average"
            f" {ratio:.3g} times that of its design {hose}{_is_like(like)}. Check the unit of load,"
            " the gauge length, the named file and hose (swapped?), the inner diameter (bore), the"
            " length, and the number, angle and load of its cords (both layers counted once)"
            + (f".{_would_fit(readings)}" if readings else "")
        ),
    ),
    "two-designs-of-one": (
        "warning",
        "it is compared with {hose} here and with {other} elsewhere. Check the specimen of this"
        " test, and which design belongs to it",
    ),
    "static-at-frequency": (
        "warning",
        "treated as static, but its log has cycles at {frequency:.3g} Hz, where cords are stiffer"
        ' than in a slow pull. If the test is dynamic, set loading = "dynamic"',
    ),
    "hose-length-not-tested": (
        "warning",
        lambda hose, ratio, like: (
            f"the length of {hose} is {ratio:.3g} times its gauge length{_is_like(like)}: the dead"
            " ends are a different share of its length than in the hose that was tested. Check the"
            " length, the gauge length and their units"
        ),
    ),
    "waveform-not-as-stated": (
        "warning",
        lambda stated, found: (
            f'waveform = "{stated}"'
            + (" (stated, or by default)" if stated == "triangular" else "")
            + ", but the log is"
            + (
                " neither triangular nor sinusoidal, and its loops are reduced as those of waveform"
                ' = "other". State the waveform'
                if found == "other"
                else f" {found}. State the waveform of the machine"
            )
        ),
    ),
    "gauge-against-length": (
        "warning",
        lambda gauge, length, like: (
            f"the gauge length is {gauge:.4g} m, but the pins are {length:.4g} m apart at slack"
            f"{_is_like(like)}. Check the gauge length, its unit and the unit of position"
        ),
    ),
    "extensometer-unlike-others": (
        "warning",
        lambda ratio, n_others, like: (
            f"for the same stroke, its extensometer shows {ratio:.3g} times the strain of the other"
            f" {n_others} tests of the specimen{_is_like(like)}. Check its range (gain), its gauge"
            " length, and whether it or a grip slipped in this test"
        ),
    ),
    "extensometer-against-stroke": (
        "warning",
        lambda ratio, like: (
            "the measured strain falls as the crosshead position rises. If one of them counts the"
            " other way, set sign = -1 for it"
            if ratio < 0
            else f"the measured strain is {ratio:.3g} times the stroke over the length at slack"
            f"{_is_like(like)}. Check the unit and the range (gain) of the extensometer, and the"
            " unit of position (stroke)"
        ),
    ),
    "extensometer-off-at-slack": (
        "warning",
        "the extensometer reads {strain:.3%} at slack. Check whether it was set to zero there",
    ),
    "channels-alike": (
        "warning",
        "the tension is identical to that of {others}, reading by reading. Check whether both"
        " channels name one column, or two cables were connected to one load cell",
    ),
    "column-of-another": (
        "warning",
        "its tension is read from the column {column!r}, which has the name of {other}. Check"
        " whether the columns are swapped",
    ),
    "log-used-twice": (
        "warning",
        "its log is identical to that of test {other}, byte for byte. Check whether the same file"
        " is named twice",
    ),
    "readings-used-twice": (
        "warning",
        "its readings are those of test {other}, although the files differ: one log was exported"
        " twice. Check whether a log of this test has the name of the other",
    ),
    "marks-of-another": (
        "warning",
        "its {n_marks} marks are those of {other}, digit by digit. Splices differ from specimen to"
        " specimen: read the tape on each. If only {other} was read, state in [uncertainty] what"
        ' the strain may differ by, such as strain = "3 %"',
    ),
    "specimens-swapped": (
        "warning",
        "its peak is {ratio:.3g} times that of {other}, and {usual:.3g} times in their {n_others}"
        " other tests: the two seem to be swapped. Check the order of `specimens` of this test, and"
        " of the load columns of its log",
    ),
    "date-against-order": (
        "warning",
        "its date is {date}, that of {other} is {of_other}, but their `order` is the reverse:"
        " correct the date, or the order, which determines what the specimen had been through",
    ),
    "marks-of-absent": (
        "warning",
        "{n_marks} of its marks name this test, whose specimens are {present}. Check `specimens` of"
        " the test, and test and specimen of these rows",
    ),
    "stiffness-jumps": (
        "warning",
        lambda other, ratio, like: (
            f"it is {ratio:.3g} times as stiff as in {other}{_is_like(like)}. Check that"
            " the unit, gain and factor of the load are those of the other test, and that file and"
            " specimen are not swapped"
        ),
    ),
    "stiffness-off-others": (
        "warning",
        lambda ratio, n_others, n_like, like: (
            f"it is {ratio:.3g} times as stiff as {n_others} of {n_like} other specimens of its"
            f" kind{_is_like(like)}. Check the unit, gain and factor of its load, its diameter, and"
            " whether the log is its own; if it is of another make, state its material,"
            " construction or condition"
        ),
    ),
    "stiffness-off-own-tests": (
        "warning",
        "relative to its other tests it is {ratio:.3g} times as stiff as others of its kind"
        " ({n_others}) are relative to theirs. Check the gain and factor of load and position, and"
        " whether the log is its own",
    ),
    "peak-off-others": (
        "warning",
        lambda ratio, like: (
            f"its greatest tension is {ratio:.3g} times that of the other tests of the specimen at"
            f" this strain{_is_like(like)}. Check that the unit, gain and factor of the load are"
            " those of the other tests, and that file and specimen are not swapped"
        ),
    ),
    "softer-by-stretch": (
        "note",
        "its greatest tension is {ratio:.3g} times that of earlier tests at this strain: the"
        " specimen was stretched further before this test, which can soften rubber by this much. A"
        " wrong unit or gain of the load would look the same",
    ),
    "tension-behind-position": (
        "warning",
        "tension lags position by {delay:.2g} s, which no specimen causes: the load was logged"
        " late, or through a filter, or the columns of load and position are interchanged. Loops"
        " and moduli are affected",
    ),
    "position-behind-tension": (
        "warning",
        "tension leads position by {delay:.2g} s, more than the damping of a specimen explains: the"
        " position was logged late, or mass attached to a moving load cell adds its inertia",
    ),
    "load-falls-for-good": (
        "warning",
        "the load ends at {share:.0%} of its peak while the crosshead stays out. If the specimen"
        " broke or slipped, state failed = true",
    ),
    "run-off-plan": (
        "warning",
        lambda experiment, levels, why, like: (
            f"not at the levels of {experiment}: {levels}"
            + (f"; {why}" if why else "")
            + (f". These are the levels of {like}: check for swapped files or rows" if like else "")
        ),
    ),
    "cord-stress-outside-band": (
        "warning",
        lambda stress, low, high: (
            f"its cords break at {_pascals(stress)} on their section; textile cords break at"
            f" {_pascals(low)} to {_pascals(high)}. Check the unit of the cord's load (of one cord,"
            " not of the fabric) and the cord_diameter"
        ),
    ),
    "cords-do-not-fit": (
        "warning",
        lambda share: (
            f"cords_per_length times cord_diameter is {share:.3g} of the width"
            + (
                ", so cords overlap. Check whether both layers are counted, or a unit is wrong"
                if share > 1
                else ". Check the units of cords_per_length and cord_diameter"
            )
        ),
    ),
    "hose-rubber-outside-band": (
        "warning",
        lambda modulus, low, high: (
            f"its rubber_modulus is {_pascals(modulus)}, but Young's modulus of hose rubber is"
            f" {_pascals(low)} to {_pascals(high)}. Check its unit, and that it is not a shear"
            " modulus"
        ),
    ),
    "wrap-angle-outside-band": (
        "warning",
        lambda angle: (
            f"its wrap_angle is {degrees(angle):.3g} degrees from the axis, but a hose only"
            " stretches above 55. Check whether it was measured from the hoop, or is in radians"
        ),
    ),
    "dead-length-large": (
        "warning",
        "{share:.0%} of its length is dead_length. Check the units of dead_length and length",
    ),
    "hose-not-of-design": (
        "warning",
        lambda hose, ratio, like: (
            f"its diameter is {ratio:.3g} times the outer_diameter of {hose}, with which it is"
            f" compared{_is_like(like)}. Check the diameter (not the wall) and its unit"
        ),
    ),
}  # fmt: skip

JERKS = 20  # lone steps of a channel: more are its way of moving

SENTENCES: Mapping[str, tuple[Severity, str | Callable[..., str]]] = {
    **_OF_READING, **_OF_STRAIN, **_OF_CYCLES, **_OF_MODULI, **_OF_HOLDS, **_OF_LINE,
    **_OF_EXPERIMENTS, **_OF_HOSES, **_OF_PLAUSIBILITY,
}  # fmt: skip
"""Severity and sentence of each note, by code."""

CAUSES = (
    "log-used-twice", "readings-used-twice", "marks-of-another", "marks-of-absent",
    "channels-alike", "specimens-swapped", "date-against-order",
    "column-of-another", "diameter-readings-apart", "stretched-diameters-apart",
    "cycles-in-other-kind", "hold-of-position", "cycles-unlike",
    "faster-than-machines", "slower-than-machines", "rate-not-as-stated", "level-not-as-stated",
    "load-never-falls", "load-zero-drifts", "load-zero-wrong", "load-negative",
    "load-steps", "load-falls-with-stretch", "pushed-in-cycles", "pushed-in-pull",
    "reference-length-under-preload",
    "reference-length-elsewhere", "reference-length-never-read",
    "tension-far-below-strength", "extensometer-late",
    "extensometer-ends", "position-ends", "load-in-steps",
    "tape-off-crosshead", "marks-alike", "splices-unlike", "loops-run-backward",
    "extensometer-against-stroke", "extensometer-unlike-others", "gauge-against-length",
    "modulus-outside-band", "strength-outside-band", "tension-above-strength", "stiffness-jumps",
    "stiffness-off-others", "stiffness-off-own-tests", "peak-off-others", "run-off-plan",
    "mean-tension-ramps",
    "cord-stress-outside-band",
    "cords-do-not-fit", "hose-rubber-outside-band", "wrap-angle-outside-band",
    "dead-length-large", "two-designs-of-one", "hose-length-not-tested", "static-at-frequency",
    "hose-not-of-design", "hose-unlike-design",
    "target-strain-missed", "lower-target-missed", "density-outside-band",
    "strain-above-band",
    "extensometer-off-at-slack", "reference-tension-elsewhere", "slack-beyond-zero",
    "length-jumps",
    "slipped-in-earlier-step", "strain-below-zero",
    "zero-moves-at-stop", "wave-not-periodic", "changes-alone-logged", "wave-changes",
    "tension-hums", "tension-late",
    "tension-filtered", "tension-behind-position",
    "loops-give-work", "loops-not-of-a-sine", "hold-load-late",
)  # fmt: skip
"""Errors in stated inputs, causes before their consequences."""

UNSTATED = ("attached-mass-matters", "compliance-matters", "lag-matters")
"""Possible machine effects that no log shows, listed after those that this log shows."""
