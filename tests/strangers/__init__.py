"""Synthetic tests of mooring elements with known truth, from laws that the package does not have.

``make("tether-ratio-kinked", 7, folder)`` writes a campaign of synthetic logs into a folder and
returns what is true of them.  The laws were written from the reports and the campaign file alone,
without the code of the package: they share no assumption with it but the form of the files.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from strangers import bench, ropes, tethers
from strangers.campaign import KEYS, Truth

__all__ = ["KEYS", "LAWS", "Truth", "make"]

_SPLICES = {
    "tension": "splice strain a power of the tension",
    "ratio": "splice strain a fixed share of the free strain",
    "mixture": "splice strain about half tension-driven, half a share of the free strain",
    "saturating": "splice strain follows the free strain along a saturating curve",
    "stiffening": "splice strain follows the free strain along a curve that steepens",
    "slip-sudden": "splices slip in sudden steps in every test",
    "slip-slow": "splices slip slowly, with the square of the tension",
}
_HYSTERESIS = {
    "smooth": "smooth viscoelastic hysteresis",
    "kinked": "rate-independent hysteresis with kinks after each reversal",
    "both": "viscoelastic and rate-independent hysteresis",
}

LAWS: dict[str, str] = {}
_MAKERS: dict[str, Callable[..., Truth]] = {}


def _register(name: str, about: str, maker: Callable[..., Truth], **options: Any) -> None:
    LAWS[name] = about
    _MAKERS[name] = partial(maker, about=about, **options)


for _splice, _text in _SPLICES.items():
    for _kind, _more in _HYSTERESIS.items():
        _register(
            f"tether-{_splice}-{_kind}",
            f"Tethers: {_text}; {_more}",
            tethers.make,
            splice=_splice,
            hysteresis=_kind,
        )
for _splice in ("tension", "ratio"):
    _register(
        f"tether-{_splice}-both-drift-play",
        f"Tethers: {_SPLICES[_splice]}; drifting load cells and play in the encoder",
        tethers.make,
        splice=_splice,
        hysteresis="both",
        drift=True,
        play=True,
    )
_register(
    "tether-hyperbolic-few-marks",
    "Tethers: unlike splices that saturate with the tension; one test, three marks",
    tethers.make,
    splice="hyperbolic",
    hysteresis="both",
    max_tests=1,
)
_register(
    "tether-tension-friction",
    "Tethers: splices driven by the tension, with friction; one test, three marks on the way up",
    tethers.make,
    splice="tension",
    hysteresis="both",
    friction=0.015,
    max_tests=1,
)
for _name, _steps in (("rope-creep-levels", False), ("rope-creep-levels-steps", True)):
    _register(
        _name,
        f"Creeping rope, three mean loads in one record, steps {'stated' if _steps else 'unsaid'}",
        ropes.make_creeping,
        steps=_steps,
    )
for _name, _text in (
    ("falling", "tau falls with the frequency as f^-n"),
    ("constant", "tau is constant"),
    ("angle", "the loss angle is constant"),
    ("fractional", "in place of the dashpot a spring-pot, the derivative of a broken order"),
    ("spectrum", "in place of one relaxation time three, over two decades"),
):
    _register(f"line-{_name}", f"Line of three parameters: {_text}", ropes.make_line, damping=_name)
_register("hold-settling", "Relaxation, crosshead creeps 5-50 um after the ramp", bench.make_hold)
_register(
    "hold-overshoot", "Relaxation, crosshead settles back by 5-50 um", bench.make_hold, back=True
)
_register(
    "hold-tether",
    "Relaxation of a tether, crosshead settles by .01-.1 % of the stroke",
    bench.make_hold,
    tether=True,
)
for _name, _loop in bench.LOOPS.items():
    _register(f"loop-{_name}", (_loop.__doc__ or "").splitlines()[0], bench.make_loop, loop=_name)
for _name, _mass, _compliance in (
    ("mass", True, False),
    ("compliance", False, True),
    ("both", True, True),
):
    for _suffix, _stated in (("", True), ("-unstated", False)):
        _register(
            f"train-{_name}{_suffix}",
            f"Load train: {_name} {'stated' if _stated else 'not stated'}",
            bench.make_train,
            mass=_mass,
            compliance=_compliance,
            stated=_stated,
        )


def make(law: str, seed: int, folder: Path, **options: Any) -> Truth:
    """Write a campaign folder of a law and return its truth, which is in the folder too.

    Parameters
    ----------
    law
        a name out of ``LAWS``.
    seed
        draws material, lengths, rates, errors and noise.
    folder
        written to; made if it is not there.
    **options
        of the family (``waveform``, ``lead_in``, ...), or ``keys``: names for ``KEYS``.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    before = dict(KEYS)
    KEYS.update(options.pop("keys", {}))
    try:
        truth = _MAKERS[law](law, seed, folder, **options)
    finally:
        KEYS.update(before)
    truth.dump(folder)
    return truth
