"""Hoses and comparisons of campaign.toml, in SI."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import pi
from pathlib import Path

import numpy as np

from reduction.campaign.model import (
    ComparisonSection,
    CordSection,
    HoseKeys,
    HoseSpecFile,
    LayerSection,
)
from reduction.campaign.plan import ComparisonPlan, TestPlan, product_of
from reduction.campaign.toml_file import TableReader, in_toml, read_toml
from reduction.prediction.cord_curve import CordCurve
from reduction.prediction.hose_prediction import HelicalLayer, HosePlan, HoseTarget
from reduction.prediction.hose_product import HoseDesign
from reduction.quantities.units import Dimension
from reduction.record.errors import SettingsError
from reduction.record.measurement import Specimen

_DIMENSIONS: dict[str, Dimension] = {
    "wrap_angle": "angle",
    "wrap_diameter": "length",
    "layer_diameters": "length",
    "inner_diameter": "length",
    "outer_diameter": "length",
    "cords_per_length": "per_length",
    "rubber_modulus": "stress",
    "cord_load_scale": "number",
    "cord_strain_scale": "number",
    "dead_length": "length",
}
"""Keys that may have a standard uncertainty."""

_MOST_CORD_STRAIN = 1.0

_PARAMETERS = {
    "wrap_diameter": "layer_diameter",
    "layer_diameters": "layer_diameter",
    "dead_length": "dead_length_share",
}


def hose_of(path: Path, name: str, place: str, keys: HoseKeys, cord: CordSection) -> HosePlan:
    """A hose in SI."""
    read = TableReader(path, place)
    given = keys.layer_diameters if keys.wrap_diameter is None else (keys.wrap_diameter,) * 2
    if given is None or None not in (keys.wrap_diameter, keys.layer_diameters):
        raise in_toml(
            path, f"{place} does not say once where its cords lie",
            found="wrap_diameter and layer_diameters" if given else "neither",
            needed="wrap_diameter, the mean of the two layers, or layer_diameters, one of each",
        )  # fmt: skip
    key = "wrap_diameter" if keys.wrap_diameter is not None else "layer_diameters"
    inner, outer = (read.value(key, text, "length") for text in given)
    numbers = {
        name: read.value(name, getattr(keys, name), _DIMENSIONS[name])
        for name in (
            "wrap_angle", "inner_diameter", "outer_diameter", "cords_per_length",
            "rubber_modulus", "cord_load_scale", "cord_strain_scale",
        )
    }  # fmt: skip
    bore = keys.minimum_inner_diameter
    share, length = _dead_length(read, keys)
    try:
        design = HoseDesign(
            **numbers,
            layer_diameter=(inner, outer),
            cord_diameter=read.value("cord_diameter", keys.cord_diameter, "length"),
            cord=_cord(read, place, cord),
            rubber_law=keys.rubber_law,
            working_share=read.value("working_share", keys.working_share, "number"),
            dead_length_share=share,
            minimum_inner_diameter=0.0
            if bore is None
            else read.value("minimum_inner_diameter", bore, "length"),
        )
    except SettingsError as error:
        if error.problem.startswith(str(path)):
            raise
        problem = error.problem.replace("layer_diameter", key)
        problem = problem.replace("dead_length_share", "dead_length over length")
        raise in_toml(
            path, f"{place}: {problem}", found=error.found, needed=error.needed,
            hint=error.hint,
        ) from error  # fmt: skip
    step = read.value("strain_step", keys.strain_step, "strain")
    if not 0 < step < 1:
        raise in_toml(
            path, f"{place}.strain_step is no step", found=f"{step:g}",
            needed='above 0 and below 1, such as "1 %"',
        )  # fmt: skip
    greatest = keys.greatest_strain
    last = np.nan if greatest is None else read.value("greatest_strain", greatest, "strain")
    if last <= 0:
        raise in_toml(
            path, f"{place}.greatest_strain is not positive", found=f"{last:g}", needed="above 0"
        )
    return HosePlan(
        name=name,
        design=design,
        standard_uncertainty=_uncertainties(read, keys, design, length),
        strain_step=step,
        greatest_strain=last,
        layers=tuple(_layer(read, layer) for layer in keys.layers),
    )


def _layer(read: TableReader, layer: LayerSection) -> HelicalLayer:
    place = f"layers.{layer.name}"
    angle = read.value(place, layer.wrap_angle, "angle")
    if not 0 < angle < pi / 2:
        raise in_toml(
            read.path, f"{read.place}.{place}.wrap_angle lies across the axis or along it",
            found=layer.wrap_angle, needed="between 0 and 90 deg, from the hose axis",
        )  # fmt: skip
    limits = [
        np.nan if text is None else read.value(place, text, "strain")
        for text in (layer.strain_limit, layer.compression_limit)
    ]
    # a comparison with NaN is false: what is not stated is no fault
    if limits[0] < 0 or limits[1] < 0 or limits[1] >= 1:
        raise in_toml(
            read.path, f"{read.place}.{place} has a limit that no layer has",
            found=f"{limits[0]:g} in tension, {limits[1]:g} in compression",
            needed="positive numbers, compression below 100 %",
        )  # fmt: skip
    return HelicalLayer(layer.name, angle, *limits)


def _cord(read: TableReader, place: str, cord: CordSection) -> CordCurve:
    at = TableReader(read.path, "cord" if place == "hose" else f"{place}.cord")
    strain = [at.value("strain", text, "strain") for text in cord.strain]
    load = [at.value("load", text, "force") for text in cord.load]
    if max(strain, default=0.0) > _MOST_CORD_STRAIN:
        raise in_toml(
            at.path, f"{at.place}.strain goes beyond what a cord can be stretched",
            found=f"{100 * max(strain):g} %", needed=f"at most {100 * _MOST_CORD_STRAIN:g} %",
            hint='A bare number is a share: 22 % is 0.22 or "22 %".',
        )  # fmt: skip
    return CordCurve(np.array(strain), np.array(load))


def _dead_length(read: TableReader, keys: HoseKeys) -> tuple[float, float]:
    """Share of the length that does not stretch, and the length, NaN where not stated."""
    length = np.nan if keys.length is None else read.value("length", keys.length, "length")
    if length <= 0:
        raise in_toml(
            read.path, f"{read.place}.length is not positive", found=keys.length, needed="above 0"
        )
    if keys.dead_length is None:
        return 0.0, length
    if keys.length is None:
        raise in_toml(
            read.path, f"{read.place}.dead_length stands without length",
            needed='length = "2.4 m", relaxed, stretch-limited ends included',
        )  # fmt: skip
    return read.value("dead_length", keys.dead_length, "length") / length, length


def _uncertainties(
    read: TableReader, keys: HoseKeys, design: HoseDesign, length: float
) -> dict[str, float]:
    """Standard uncertainties in SI, by parameter; % is of the value itself."""
    found: dict[str, float] = {}
    for key, text in keys.standard_uncertainty.items():
        place = f"standard_uncertainty.{key}"
        if key not in _DIMENSIONS:
            raise in_toml(
                read.path, f"{read.place}.{place} is no number of a hose that may be uncertain",
                needed="one of " + ", ".join(_DIMENSIONS),
            )  # fmt: skip
        if key in ("wrap_diameter", "layer_diameters") and getattr(keys, key) is None:
            raise in_toml(
                read.path, f"{read.place}.{place} stands without {key}",
                needed="the key that the hose has",
            )  # fmt: skip
        name = _PARAMETERS.get(key, key)
        value = design.wrap_diameter if name == "layer_diameter" else getattr(design, name)
        if isinstance(text, str) and text.strip().endswith("%"):
            number = read.value(place, text, "strain") * float(np.mean(value))
        else:
            number = read.value(place, text, _DIMENSIONS[key])
            if key == "dead_length":
                number = number / length
        size = abs(float(np.mean(value)))
        # a dead length may be nil and not known well
        if not (np.isfinite(number) and 0 <= number < (size or 1.0)):
            raise in_toml(
                read.path, f"{read.place}.{place} is no standard uncertainty", found=str(text),
                needed="zero or more, below the number itself; a dead_length needs the length",
            )  # fmt: skip
        found[name] = number
    return found


def load_hose(path: Path) -> tuple[HosePlan, HoseSpecFile]:
    """Read SPEC.toml of a hose."""
    file = read_toml(
        path,
        HoseSpecFile,
        what="the hose",
        needed="a SPEC.toml with [hose] and [cord]",
        keys="docs/predictions.md lists every key",
    )
    return hose_of(path, path.stem, "hose", file.hose, file.cord), file


def target_of(path: Path, file: HoseSpecFile) -> HoseTarget | None:
    """What SPEC.toml asks of a hose, in SI; None where it asks nothing."""
    if file.target is None:
        return None
    read = TableReader(path, "target")
    return HoseTarget(
        strain=read.value("strain", file.target.strain, "strain"),
        tension=read.optional("tension", file.target.tension, "force"),
    )


_HAVE_CURVE = ("cyclic", "fatigue", "quasi-static", "tensile")


def plan_comparison(
    path: Path,
    name: str,
    section: ComparisonSection,
    *,
    tests: Mapping[str, TestPlan],
    hoses: Collection[str],
    specimens: Mapping[str, Specimen],
) -> ComparisonPlan:
    """A comparison with every name in it resolved."""
    place = f"comparison '{name}'"
    found = product_of(section.measured, tests)
    if found is None:
        raise in_toml(
            path, f"{place}: what was measured is no test of the campaign",
            found=section.measured, needed="a test, or test/step: " + ", ".join(tests),
        )  # fmt: skip
    product, kind = found
    if kind not in _HAVE_CURVE:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no curve of tension against strain",
            found=kind, needed="one of " + ", ".join(_HAVE_CURVE),
        )  # fmt: skip
    if section.predicted not in hoses:
        raise in_toml(
            path, f"{place}: what is predicted is no hose of the campaign",
            found=section.predicted, needed="one of [hoses]: " + (", ".join(hoses) or "none"),
        )  # fmt: skip
    pulled = tests[section.measured.partition("/")[0]].specimens
    if section.specimen is None and len(pulled) > 1:
        raise in_toml(
            path, f"{place}: '{section.measured}' has several specimens",
            needed="specimen = one of " + ", ".join(pulled),
        )  # fmt: skip
    specimen = section.specimen or pulled[0]
    if specimen not in pulled:
        raise in_toml(
            path, f"{place}: '{section.measured}' has no such specimen", found=specimen,
            needed="one of " + ", ".join(pulled),
        )  # fmt: skip
    if specimens[specimen].kind != "stretch hose":
        raise in_toml(
            path, f"{place}: '{specimen}' is no stretch hose", found=specimens[specimen].kind,
            needed='kind = "stretch hose" of what is held against a hose',
        )  # fmt: skip
    if len(set(section.calibrate)) < len(section.calibrate):
        raise in_toml(
            path, f"{place}: a number is to be calibrated twice",
            found=", ".join(section.calibrate),
        )  # fmt: skip
    return ComparisonPlan(
        name=name,
        measured=product,
        specimen=specimen,
        predicted=section.predicted,
        loading=section.loading,
        calibrate=section.calibrate,
    )
