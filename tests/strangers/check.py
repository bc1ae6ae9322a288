"""Whether a law keeps its own balance, its truth is that of its logs, and its errors are stated."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import quad

from strangers import Truth, make
from strangers.campaign import NOTICE
from strangers.cycles import closed_area
from strangers.instruments import SI
from strangers.materials import Array, Rubber, draw_curve, maxwell, stop
from strangers.ropes import (
    draw_line,
    line_response,
    static_stiffness,
    static_strain,
    static_tension,
)


def _close(a: float, b: float, relative: float, what: str, absolute: float = 0.0) -> None:
    assert abs(a - b) <= relative * abs(b) + absolute, f"{what}: {a} is not {b}"


def check_materials() -> None:
    """Energy balance of each element against its closed form."""
    rng = np.random.default_rng(1)
    size = 4000
    phase = 2.0 * np.pi * np.arange(10 * size + 1) / size
    amplitude, mean = 0.3, 1.0
    strain = mean - amplitude * np.cos(phase)
    last = slice(-size - 1, -1)
    for family in ("mooney", "ogden", "gent", "yeoh", "polynomial"):
        curve = draw_curve(rng, 7e5, family)
        _close(float(curve.stress(np.array(1.0))), 7e5, 1e-12, family)
        area = closed_area(strain[last], curve.stress(strain)[last])
        assert abs(area) < 1e-4 * 7e5 * amplitude, f"{family}: elastic loop of {area} J/m3"
    step, tau = 10.0 / size, 2.0
    x = 2.0 * np.pi / 10.0 * tau
    area = closed_area(strain[last], maxwell(step, strain, tau)[last])
    _close(area, math.pi * amplitude**2 * x / (1.0 + x * x), 1e-4, "Maxwell loop")
    limit = 0.02
    area = closed_area(strain[last], stop(strain - strain[0], limit)[last])
    _close(area, 4.0 * limit * (amplitude - limit), 1e-3, "slider loop")
    curve = draw_curve(rng, 7e5, "mooney")
    rubber = Rubber(curve, ((0.1, tau),), "line", ((2e6, limit),))
    area = closed_area(strain[last], rubber.stress(step, strain)[last])
    stiff = float(curve.stress(np.array(1.0)))
    expected = 0.1 * stiff * math.pi * amplitude**2 * x / (1.0 + x * x)
    _close(area, expected + 2e6 * 4.0 * limit * (amplitude - limit), 2e-3, "rubber loop")


def check_lines() -> None:
    """Invert the static curve of the line; small cycles against the printed equations."""
    rng = np.random.default_rng(2)
    for damping in ("falling", "constant"):
        c = draw_line(rng, damping)
        tension = np.linspace(0.0, 0.5, 26) * c["strength"]
        strain = static_strain(tension, c)
        assert np.allclose(static_tension(strain, c), tension, rtol=1e-9, atol=1e-6)
        apart = quad(lambda t, c=c: 1.0 / float(static_stiffness(t, c)), 0.0, tension[13])[0]
        _close(float(strain[13]), apart, 1e-8, "static strain")
        slope = np.gradient(tension, strain)[13]
        static = c["K_a"] + c["K_b"] * tension[13] + c["K_c"] * tension[13] ** 2
        _close(float(slope), static, 2e-3, "K_0")
        f, mean, swing = 0.23, 0.2 * c["strength"], 1e-4 * c["strength"]
        out = {
            k: float(v[0])
            for k, v in line_response(np.array(f), np.array(mean), np.array(swing), c).items()
        }
        k0, k1 = out["quasi_static_spring_constant"], out["dissipation_spring_constant"]
        x = 2.0 * math.pi * f * out["relaxation_time"]
        apparent = math.sqrt((k0**2 + (k0 + k1) ** 2 * x * x) / (1.0 + x * x))
        energy = math.pi * k1 * swing**2 * x / (k0**2 + (k0 + k1) ** 2 * x * x)
        _close(out["apparent_spring_constant"], apparent, 1e-4, "K_ap")
        _close(out["hysteresis_energy"], energy, 1e-3, "H")
        _close(out["dissipation_spring_constant_closed_form"], k1, 1e-3, "K_1")
        _close(out["relaxation_time_closed_form"], out["relaxation_time"], 2e-3, "tau")


def _finite(value: Any, path: str) -> None:
    if isinstance(value, dict):
        for key, item in value.items():
            _finite(item, f"{path}/{key}")
    elif isinstance(value, list):
        for item in value:
            _finite(item, path)
    elif isinstance(value, float):
        assert math.isfinite(value), f"{path}: {value}"


def _log(path: Path) -> dict[str, Array]:
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[0] == f"# {NOTICE}"
    table = np.loadtxt(lines[3:], delimiter=",", ndmin=2)
    assert np.all(np.isfinite(table))
    return dict(zip(lines[2].split(","), table.T, strict=True))


def check_folder(folder: Path, truth: Truth) -> dict[str, dict[str, Array]]:
    """Campaign parses, its files are there, errors are inside what is stated, no NaN."""
    document = tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))
    assert document["campaign"]["synthetic"] is True
    columns: list[str] = []
    for channel in document["layouts"]["logger"]["channels"].values():
        inner = [channel] if "column" in channel else list(channel.values())
        columns.extend(item["column"] for item in inner)
    logs = {}
    for name, test in document["tests"].items():
        logs[name] = _log(folder / test["file"])
        assert set(columns) <= set(logs[name]), f"{name}: columns"
        assert np.all(np.diff(logs[name]["time_s"]) > 0.0), f"{name}: time"
    _finite(json.loads((folder / "truth.json").read_text(encoding="utf-8")), "truth")
    with np.load(folder / "truth.npz") as stored:
        for key in stored.files:
            assert np.all(np.isfinite(stored[key])), key
    for name, entry in truth.errors.items():
        stated, drawn = float(entry["stated"]), float(entry["drawn"])
        wide = stated if entry["form"] == "half_width" else 4.5 * float(entry["stated_standard"])
        assert abs(drawn) <= wide, f"{name}: drew {drawn}, stated {stated}"
        if name == "lag":
            assert 0.0 <= drawn * SI[str(entry["unit"])] <= 0.0301 or truth.family != "tether"
    return logs


def check_tether(folder: Path, truth: Truth, logs: dict[str, dict[str, Array]]) -> None:
    """Tangents integrate to the stress, loops to H; logs agree with the truth."""
    # a slip moves the cycles along the strain: the grid common to them misses more of the ends
    loose = 0.5 if "slip-sudden" in truth.law else 0.15 if "slip" in truth.law else 0.02
    for name, specimens in truth.tests.items():
        for specimen, scalars in specimens.items():
            area = truth.constants["specimens"][specimen]["area_m2"]
            place = f"{name}/{specimen}"
            grid = truth.arrays[f"{place}/strain"]
            force = {}
            for branch in ("ascending", "descending"):
                tension = truth.arrays[f"{place}/{branch}/branch_tension"]
                tangent = truth.arrays[f"{place}/{branch}/tangent_modulus"]
                inner = slice(12, -12)  # a sine makes the tangent of a smooth law steep at its ends
                rise = float(np.trapezoid(tangent[inner], grid[inner])) * area
                expected = float(tension[inner][-1] - tension[inner][0])
                _close(rise, expected, 6e-3, f"{place} {branch} integral")
                force[branch] = tension
            loop = float(np.trapezoid(force["ascending"] - force["descending"], grid))
            _close(loop, scalars["hysteresis_energy"], loose, f"{place} H", 0.01)
            loss = scalars["loss_spring_constant"] * math.pi * scalars["strain_amplitude"] ** 2
            _close(loss, scalars["hysteresis_energy"], 5e-3, f"{place} energy balance")
            ratio = scalars["tension_amplitude"] / scalars["strain_amplitude"]
            _close(scalars["apparent_spring_constant"], ratio, 5e-3, f"{place} K_ap")
            log = logs[name]
            column = next(c for c in log if c.startswith(f"load_{specimen}"))
            seen = log[column] * SI[column.rsplit("_", 1)[1]]
            top = float(np.max(seen[seen.size // 2 :]))
            _close(top, scalars["peak_tension"], 0.12, f"{place} peak")
            for hold, (moment, *points, strain, _) in scalars["marks"].items():
                near, far_toe, _ = points
                free = scalars["free_length_m"] * (1.0 + strain)
                _close(far_toe - near, free, 1e-9, f"{place} {hold} free length")
                if hold != "slack":
                    along = next(c for c in log if c.startswith("crosshead"))
                    place_ = np.interp(moment, log["time_s"], log[along])
                    place_ *= SI[along.rsplit("_", 1)[1]]
                    _close(float(place_), points[2], 0.0, f"{place} {hold}", 0.04)
    marks = (folder / "marks.csv").read_text(encoding="utf-8").splitlines()
    assert len(marks) == 1 + 8 * len(truth.tests)


def check_rope(truth: Truth, logs: dict[str, dict[str, Array]]) -> None:
    """Secants against tangents of the levels, and the log against the truth."""
    for level, scalars in truth.tests["R-1"].items():
        grid = truth.arrays[f"R-1/{level}/tension_grid"]
        spans = [
            float(np.trapezoid(1.0 / truth.arrays[key], grid))
            for key in (
                f"R-1/{level}/{b}/tangent_spring_constant_at_tension"
                for b in ("ascending", "descending")
            )
        ]
        mean = (grid[-1] - grid[0]) / (0.5 * sum(spans))
        _close(mean, scalars["secant_spring_constant"], 0.02, f"{level} secant")
        elastic = scalars["secant_spring_constant_elastic"]
        _close(scalars["secant_spring_constant"], elastic, 0.08, f"{level} elastic secant")
        log = logs["R-1"]
        inside = (log["time_s"] > scalars["from"]) & (log["time_s"] < scalars["to"])
        force = log["load_kN"][inside] * 1e3
        spread = float(np.ptp(force)) / 2.0
        _close(spread, scalars["tension_amplitude"], 0.05, f"{level} amplitude")


def check_line(truth: Truth) -> None:
    """Last cycle of the exact records against the truth of the steady cycle."""
    for name, specimens in truth.tests.items():
        point = specimens["line-1"]
        strain = truth.arrays[f"{name}/line-1/exact/strain"]
        tension = truth.arrays[f"{name}/line-1/exact/tension"]
        rate = 20.0 if point["frequency"] < 0.2 else 40.0
        size = rate / point["frequency"]
        count = round(size) if abs(size - round(size)) < 1e-6 else round(3.0 * size)
        e, t = strain[-count:], tension[-count:]
        turns = count / size
        apparent = float(np.ptp(t) / np.ptp(e))
        _close(apparent, point["apparent_spring_constant"], 3e-3, f"{name} K_ap")
        _close(closed_area(e, t) / turns, point["hysteresis_energy"], 0.02, f"{name} H")
        k0 = point["quasi_static_spring_constant"]
        k1 = point["dissipation_spring_constant_closed_form"]
        assert k0 < point["apparent_spring_constant"] < k0 + k1, f"{name}: order of constants"


def check_hold(truth: Truth, logs: dict[str, dict[str, Array]]) -> None:
    """Prony sum is the tension at the end of the ramp; the settling is as small as said."""
    for name, specimens in truth.tests.items():
        scalars = specimens["piece"]
        _close(scalars["prony_sum_at_ramp_end"], scalars["peak"], 1e-9, f"{name} sum")
        assert 0.0 < scalars["drop_to_end"] <= scalars["drop_to_infinity"] < 0.7
        _close(scalars["drop_recorded"], scalars["drop_to_end"], 0.0, f"{name} drop", 0.01)
        seen = float(logs[name]["load_N"].max())
        assert seen < 1.05 * scalars["largest"], f"{name}: log above the peak"


def check_loop(truth: Truth) -> None:
    """Hold closed forms of the laws against the exact record."""
    scalars = truth.tests["D-1"]["piece"]
    law = truth.law.removeprefix("loop-")
    names = ["hysteresis_energy", "apparent_spring_constant", "loss_factor"]
    if law == "relaxing-mean":  # the drift is in the area of the record, not in the law
        names = ["apparent_spring_constant"]
        free = float(truth.arrays["D-1/piece/record/hysteresis_energy_drift_free"][5:].mean())
        size = scalars["apparent_spring_constant"] * scalars["strain_amplitude"] ** 2
        _close(free, scalars["hysteresis_energy"], 0.02, "area without drift", 2e-3 * size)
    loose = 0.05 if law in ("settling-angle", "relaxing-mean") else 5e-3
    for name in names:
        record = float(truth.arrays[f"D-1/piece/record/{name}"][2:].mean())
        size = scalars["apparent_spring_constant"] * scalars["strain_amplitude"] ** 2
        slack = {"hysteresis_energy": 1e-4 * size, "loss_factor": 1e-4}.get(name, 0.0)
        _close(record, scalars[name], loose, f"{law} {name}", slack)
    if law == "unequal-elastic":
        assert abs(scalars["loss_factor"]) < 1e-4
    if law == "work-out":
        assert scalars["hysteresis_energy"] < 0.0


def check_train(truth: Truth) -> None:
    """See that mass and compliance move the crude answers as they should."""
    mass = truth.constants["attached_mass_kg"]
    length = truth.constants["reference_length_m"]
    compliance = truth.constants["machine_compliance_m_per_N"]
    for name, specimens in truth.tests.items():
        scalars = specimens["piece"]
        crude, true = scalars["uncorrected"], scalars["apparent_spring_constant"]
        omega = 2.0 * math.pi * scalars["frequency"]
        felt = true - mass * omega**2 * length
        if felt > 0.3 * true:
            expected = felt / (1.0 + compliance / length * true)
            _close(crude["apparent_spring_constant"], expected, 0.05, f"{name} crude K_ap")


def check_law(law: str, seed: int, folder: Path) -> None:
    """Make one realisation of a law and check it."""
    truth = make(law, seed, folder)
    logs = check_folder(folder, truth)
    if truth.family == "tether":
        check_tether(folder, truth, logs)
    elif truth.family == "rope":
        check_rope(truth, logs)
    elif truth.family == "line":
        check_line(truth)
    elif truth.family == "hold":
        check_hold(truth, logs)
    elif truth.family == "loop":
        check_loop(truth)
    else:
        check_train(truth)
