"""A measured hose beside its prediction: every number of the comparison.

References
----------
.. [1] W. Paul, "Hose Elements for Buoy Moorings: Design, Fabrication, and Mechanical
   Properties," Woods Hole Oceanog. Inst., Woods Hole, MA, Tech. Rep. WHOI-2004-06, 2004.
.. [2] ASME V&V 20-2009, "Standard for Verification and Validation in Computational Fluid
   Dynamics and Heat Transfer."
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reduction.compare.calibrate import calibrate_hose
from reduction.compare.difference import cycle_differences, difference_of, energy_difference
from reduction.compare.events import event_differences
from reduction.compare.inputs import input_draws
from reduction.compare.measuredcurve import MeasuredCurve
from reduction.compare.pickup import PickUp, measured_pick_up
from reduction.compare.plausibility import plausibility_of_working_strain
from reduction.compare.product import Comparison, EventDifference
from reduction.compare.validation import N_DRAWS, validate_curve
from reduction.errors import SettingsError
from reduction.predict.hose import predict_hose
from reduction.predict.product import HoseDesign, HosePrediction
from reduction.record import Bools, Floats

_DYNAMIC = (
    "the test is dynamic and the cord curve static: nylon is stiffer under quick load, so that a "
    "prediction is expected to stretch more than this test; a difference is not of the model alone"
)


def compare_hose(
    design: HoseDesign,
    measured: MeasuredCurve,
    *,
    standard_uncertainty: Mapping[str, float] | None = None,
    calibrate: Sequence[str] = (),
) -> Comparison:
    """Hold a prediction against a test.

    Parameters
    ----------
    design : HoseDesign
        One hose.
    measured : MeasuredCurve
        The test. [SI]
    standard_uncertainty : mapping of str to float, optional
        By name of `reduction.predict.product.HOSE_PARAMETERS`. [SI]
    calibrate : sequence of str
        Numbers of the hose to be fitted to the test as well; none where empty.

    Returns
    -------
    comparison : Comparison
        Differences of every curve that was measured; events, energy, cycles, verdict and
        calibration by the judged one. [SI]

    Raises
    ------
    SettingsError
        If the design is of many hoses, or a name or an uncertainty cannot be used.
    DataError
        If prediction and test have no strain in common, or too few for the calibration.
    FitError
        If the calibration does not come to an end.

    Notes
    -----
    Every difference is predicted less measured [2]_.  The prediction is elastic; it is judged
    by the midline of the loop, since either branch is off by half of a loop that no cord
    curve knows of.  The verdict reads the prediction at the strains of the samples, as the curve
    was, so that a kink is rounded in both.  Where one branch was measured, that one is judged,
    and a note says so.

    Strains beyond the predicted break of the cords are not in any difference; a note counts them.

    Examples
    --------
    >>> from reduction.compare.measured import measured_curve
    >>> from reduction.predict.cordcurve import CordCurve
    >>> hose = HoseDesign(1.117, (0.0889, 0.0889), 0.0635, 0.127, 34 / 0.0254, 5.6e-4, 1.4e6,
    ...     CordCurve(np.array([0.0, 0.2]), np.array([0.0, 130.0])))
    >>> stroke = np.linspace(0.0, 1.0, 1001)
    >>> softer = measured_curve(stroke, 0.9 * predict_hose(hose, stroke).tension, loading="static")
    >>> found = compare_hose(hose, softer, standard_uncertainty={"rubber_modulus": 0.01e6})
    >>> print(round(found.differences["ascending"].relative_rms, 3), found.validation.agrees)
    0.111 False
    """
    if design.shape:
        raise SettingsError(
            "a comparison is of one hose", found=f"designs of shape {design.shape}", needed="one"
        )
    known = dict(standard_uncertainty or {})
    prediction = predict_hose(design, measured.strain)
    differences = {
        curve: difference_of(
            measured.strain, prediction.tension, measured.tension_of(curve), curve=curve
        )
        for curve in measured.curves()
    }
    inputs = input_draws(design, known, measured.strain, n_draws=N_DRAWS)
    events = event_differences(design, measured, standard_uncertainty=known)
    calibration = (
        calibrate_hose(design, measured, calibrate, standard_uncertainty=known)
        if calibrate
        else None
    )
    pick_up = measured_pick_up(measured)
    return Comparison(
        measured=measured,
        prediction=prediction,
        judged=measured.judged,
        differences=differences,
        events=events,
        energy=energy_difference(prediction.tension, measured),
        cycles=cycle_differences(prediction.tension, measured),
        validation=validate_curve(
            _as_read(design, measured, prediction), measured, input_error=inputs
        ),
        calibration=calibration,
        notes=(*_notes(design, measured, prediction, events[1]), *_of_pick_up(pick_up)),
        measured_pick_up_strain=pick_up.strain,
        measured_pick_up_strain_standard_uncertainty=pick_up.standard_uncertainty,
    )


def _as_read(design: HoseDesign, measured: MeasuredCurve, prediction: HosePrediction) -> Floats:
    """Prediction as the test would show it; plain where it is broken beside a strain."""
    node = measured.reading.node
    there = np.isfinite(measured.tension_of(measured.judged))
    # the curve goes on just below zero, where a record that is read low has strains
    read = measured.reading.of(np.sign(node) * predict_hose(design, np.abs(node)).tension)
    return np.where(there & np.isfinite(read), read, prediction.tension)


def _of_pick_up(found: PickUp) -> tuple[str, ...]:
    if not found.reason:
        return ()
    return (f"where the cords of the test pick up is not shown: {found.reason}",)


def _notes(
    design: HoseDesign,
    measured: MeasuredCurve,
    prediction: HosePrediction,
    working: EventDifference,
) -> tuple[str, ...]:
    notes = list(measured.notes)
    if measured.loading == "dynamic":
        notes.append(_DYNAMIC)
    seen: Bools = np.isfinite(measured.tension_of(measured.judged))
    n_broken = int(np.sum(seen & prediction.is_broken))
    if n_broken:
        notes.append(
            f"the test went on to strain {measured.strain[seen].max():.4g}; cords are predicted "
            f"broken at {n_broken} of its {int(seen.sum())} strains, which are in no difference"
        )
    angle = float(design.wrap_angle)
    said = [plausibility_of_working_strain(angle, working.strain)]
    if np.isfinite(working.measured_strain):
        said.append(
            plausibility_of_working_strain(angle, working.measured_strain, loading=measured.loading)
        )
    else:
        last = np.append(measured.strain[seen], measured.end_strain)
        ended = float(np.nanmax(last))
        notes.append(
            f"the judged curve ends at strain {ended:.4g}, before the predicted working load"
        )
    sides = ("predicted", "measured")
    notes += [f"{side} {text}" for side, text in zip(sides, said, strict=False) if text]
    return tuple(notes)
