"""MoorDyn itself, in a process of its own: one line between two points, stretched as it is told."""

import json
import subprocess
import sys

import numpy as np
from export_readers import moordyn_sections

DRIVER = """
import json, math, sys
import moordyn
job = json.load(open(sys.argv[1]))
system = moordyn.Create(job["deck"])
if system is None:
    raise SystemExit(3)
length, out = job["length"], []
place = lambda strain: [0.0, 0.0, -100.0 + length * (1 + strain)]
start = job["strains"][0] if "strains" in job else job["mean"]
if moordyn.Init(system, place(start), [0.0, 0.0, 0.0]):
    raise SystemExit(4)
line, time = moordyn.GetLine(system, 1), 0.0
if "strains" in job:
    here = start
    for strain in job["strains"]:
        speed = (strain - here) * length / (10 * job["step"])
        for count in range(10):
            moordyn.Step(system, place(here + (strain - here) * count / 10), [0.0, 0.0, speed], time, job["step"])
            time += job["step"]
        for count in range(job["rest"]):
            moordyn.Step(system, place(strain), [0.0, 0.0, 0.0], time, job["step"])
            time += job["step"]
        here = strain
        out.append(moordyn.GetLineFairTen(line))
else:
    omega, step = 2 * math.pi * job["frequency"], 1 / job["frequency"] / 200
    for count in range(200 * job["cycles"]):
        phase = omega * time
        moordyn.Step(system, place(job["mean"] + job["amplitude"] * math.sin(phase)),
                     [0.0, 0.0, job["amplitude"] * omega * length * math.cos(phase)], time, step)
        time += step
        out.append(moordyn.GetLineFairTen(line))
moordyn.Close(system)
json.dump(out, open(job["out"], "w"))
"""


def write(folder, files):
    for name, text in files.items():
        (folder / (name or "deck.dat")).write_text(text)


def run(folder, **job):
    deck = folder / "deck.dat"
    ((*_, length, _, _),) = moordyn_sections(deck.read_text())["LINES"]
    job |= {"deck": str(deck), "length": float(length), "out": str(folder / "out.json")}
    (folder / "job.json").write_text(json.dumps(job))
    done = subprocess.run(
        [sys.executable, "-c", DRIVER, str(folder / "job.json")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    return done, (
        np.array(json.loads((folder / "out.json").read_text())) if not done.returncode else None
    )


def at_rest(folder, strains, *, step=0.1, rest=100):
    done, tension = run(folder, strains=list(strains), step=step, rest=rest)
    assert done.returncode == 0, done.stdout[-800:] + done.stderr[-400:]
    return tension


def last_cycles(tension):
    """Sine and cosine of the tension of the last two cycles."""
    phase = 2 * np.pi * np.arange(400) / 200
    waves = np.stack([np.ones(400), np.sin(phase), np.cos(phase)], axis=1)
    return np.linalg.lstsq(waves, tension[-400:], rcond=None)[0][1:]
