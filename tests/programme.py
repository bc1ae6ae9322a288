"""Logs of a rope programme from known stiffness, creep and life, for the tests of its reduction.

Nothing here was measured: a line of stated stiffness, pulled by stated tensions.
"""

from dataclasses import dataclass, field

import numpy as np

STRENGTH = 1e5  # rated break strength [N]
STEP = 0.5  # s
PERIOD = 20.0  # s
N_BEDDING, N_LEVEL, N_LIFE = 20, 30, 60
LEVELS = ((0.10, 0.05), (0.20, 0.05), (0.30, 0.10))  # mean and amplitude over the strength
LAST = 10
REFERENCE_TIME = 600.0
NOISE = 20.0  # N
BREAK = 93_000.0
STRAIN_AT_BREAK = 0.115

CAMPAIGN = """
[campaign]
id = "rope-programme"
title = "A rope programme in one log"
source = "synthetic, from known stiffness and creep"
synthetic = true
[specimens.R-1]
kind = "rope"
rated_break_strength = "100 kN"
[specimens.R-2]
kind = "rope"
rated_break_strength = "100 kN"
[layouts.logger]
format = "delimited"
delimiter = ","
[layouts.logger.channels]
time = { column = "t_s", unit = "s" }
crosshead_position = { column = "x_m", unit = "m", datum = "displacement" }
tension.1 = { column = "F_N", unit = "N" }
strain.1 = { column = "e", unit = "1" }
[defaults]
layout = "logger"
control = "load"
"""
ONE_LOG = """
[tests.P-7]
file = "P-7.csv"
specimens = ["R-1"]
"""


def bedding_stiffness(cycle):
    return 6e5 * (1 - 0.4 * np.exp(-(cycle - 1) / 4))


def bedding_foot(cycle):
    return 0.02 * (1 - np.exp(-(cycle - 1) / 5))


def static_stiffness(elapsed):
    return 5e5 - 1.5e4 * np.log10(elapsed / REFERENCE_TIME)


def level_stiffness(level, cycle):
    return (1.0e6, 1.3e6, 1.2e6)[level] * (1 - 0.05 * np.exp(-cycle / 3))


CREEP = 0.0012  # strain a decade


def crept(since):
    """Creep strain since the end of a ramp of 20 s at an even rate, by superposition."""
    return CREEP * (
        (since / 20 + 1) * np.log10(since / 20 + 1)
        - since / 20 * np.log10(np.maximum(since, 1e-9) / 20)
    )


@dataclass
class Log:
    """Time, tension and strain, piece by piece, and when each step began and ended."""

    time: list = field(default_factory=lambda: [np.array([0.0])])
    tension: list = field(default_factory=lambda: [np.array([0.0])])
    strain: list = field(default_factory=lambda: [np.array([0.0])])
    steps: dict = field(default_factory=dict)

    @property
    def now(self):
        return self.time[-1][-1]

    @property
    def state(self):
        return self.tension[-1][-1], self.strain[-1][-1]

    def go(self, duration, tension, strain):
        """A piece of a law in the time since its begin."""
        since = np.arange(1, round(duration / STEP) + 1) * STEP
        self.time.append(self.now + since)
        self.tension.append(np.broadcast_to(tension(since), since.shape))
        self.strain.append(np.broadcast_to(strain(since), since.shape))

    def ramp(self, duration, tension, strain):
        load, stretch = self.state
        self.go(
            duration,
            lambda since: load + (tension - load) * since / duration,
            lambda since: stretch + (strain - stretch) * since / duration,
        )

    def cycle(self, valley, peak, stiffness, next_foot):
        foot = self.state[1]
        self.ramp(PERIOD / 2, peak, foot + (peak - valley) / stiffness)
        self.ramp(PERIOD / 2, valley, next_foot)

    def step(self, name, begin):
        self.steps[name] = (begin, self.now)


def programme_log():
    """Bedding-in, two holds, three levels, creep, and cycles until the line parts."""
    log = Log()
    log.go(30, lambda since: 0.0, lambda since: 0.0)

    begin = log.now
    valley, peak = 0.05 * STRENGTH, 0.30 * STRENGTH
    start = 0.01
    log.ramp(20, valley, start + bedding_foot(1))
    log.go(10, lambda since: valley, lambda since: start + bedding_foot(1))
    for number in range(1, N_BEDDING + 1):
        log.cycle(valley, peak, bedding_stiffness(number), start + bedding_foot(number + 1))
    log.step("bedding-in", begin)

    begin = log.now
    low, high = 0.10 * STRENGTH, 0.30 * STRENGTH
    log.ramp(20, low, 0.04)
    log.go(600, lambda since: low, lambda since: 0.04)
    log.ramp(20, high, 0.04 + (high - low) / static_stiffness(10.0))
    log.go(
        3600, lambda since: high, lambda since: 0.04 + (high - low) / static_stiffness(since + 10)
    )
    log.step("quasi-static", begin)

    for level, (mean, amplitude) in enumerate(LEVELS):
        begin = log.now
        valley, peak = (mean - amplitude) * STRENGTH, (mean + amplitude) * STRENGTH
        foot = 0.03 + 0.01 * level
        log.ramp(20, valley, foot)
        for number in range(1, N_LEVEL + 1):
            log.cycle(valley, peak, level_stiffness(level, number), foot)
        log.go(10, lambda since, valley=valley: valley, lambda since, foot=foot: foot)
        log.step(f"dynamic {level + 1}", begin)

    begin = log.now
    log.ramp(20, 0.4 * STRENGTH, 0.06)
    log.go(7200, lambda since: 0.4 * STRENGTH, lambda since: 0.06 + crept(since))
    log.step("creep", begin)

    begin = log.now
    valley, peak = 0.05 * STRENGTH, 0.50 * STRENGTH
    log.ramp(20, valley, 0.04)
    for _ in range(N_LIFE):
        log.cycle(valley, peak, 1e6, 0.04)
    log.ramp(6, valley + 0.6 * (peak - valley), 0.04 + 0.6 * (peak - valley) / 1e6)
    reached = log.state[1]
    # parted: no tension, and the machine runs on
    log.go(30, lambda since: 0.0, lambda since: reached + 1e-3 * since)
    log.step("life", begin)
    return log


def tensile_log():
    """A pull at a constant rate of strain to a break, after which the crosshead goes on."""
    log = Log()
    log.go(20, lambda since: 0.0, lambda since: 0.0)
    duration = 200.0

    def stretch(since):
        return STRAIN_AT_BREAK * since / duration

    def load(since):
        share = since / duration
        return BREAK * (0.4 * share + 0.6 * share**2)

    log.go(duration, load, stretch)
    log.go(10, lambda since: 0.0, lambda since: stretch(since + duration))
    return log


def write(log, path, seed=5):
    """The log as a test house sends it, with noise."""
    noise = np.random.default_rng(seed)
    time, tension, strain = (np.concatenate(one) for one in (log.time, log.tension, log.strain))
    columns = [
        time,
        10 * strain + noise.normal(0, 2e-6, time.size),
        tension + noise.normal(0, NOISE, time.size),
        strain + noise.normal(0, 2e-6, time.size),
    ]
    np.savetxt(
        path, np.column_stack(columns), delimiter=",", header="t_s,x_m,F_N,e", comments="",
        fmt=["%.2f", "%.6f", "%.1f", "%.7f"],
    )  # fmt: skip


KINDS = {
    "bedding-in": "bedding-in",
    "quasi-static": "quasi-static",
    "creep": "creep",
    "life": "fatigue",
}


def stopped_log():
    """A pull that is taken back from 60 % of the strength."""
    log = Log()
    log.go(20, lambda since: 0.0, lambda since: 0.0)
    log.ramp(100, 0.6 * STRENGTH, 0.08)
    log.ramp(100, 0.0, 0.01)
    log.go(20, lambda since: 0.0, lambda since: 0.01)
    return log


N_SNAP = 25


def snap_log(valley=0.0):
    """Cycles in which the machine goes back by half as much again as the line does."""
    log = Log()
    log.go(30, lambda since: valley, lambda since: 0.0)
    for _ in range(N_SNAP):
        log.ramp(PERIOD / 4, valley, 0.02)
        log.ramp(PERIOD / 4, 0.3 * STRENGTH, 0.06)
        log.ramp(PERIOD / 4, valley, 0.02)
        log.ramp(PERIOD / 4, valley, 0.0)
    log.go(30, lambda since: valley, lambda since: 0.0)
    return log


def steps_of(log, **kinds):
    """The steps of a log as a campaign has them."""
    return "\n".join(
        f'[[tests.P-7.steps]]\nname = "{name}"\nfrom = "{begin:g} s"\nto = "{end:g} s"\n'
        f'kind = "{(KINDS | kinds).get(name, "cyclic")}"'
        for name, (begin, end) in log.steps.items()
    )


def single(name, kind, *lines, specimen="R-1"):
    """A test with a log of its own."""
    return "\n".join(
        [f"[tests.{name}]", f'file = "{name}.csv"', f'specimens = ["{specimen}"]',
         f'kind = "{kind}"', *lines]
    )  # fmt: skip


def write_campaign(folder, *parts):
    """A campaign of tests given as text."""
    path = folder / "campaign.toml"
    path.write_text("\n".join([CAMPAIGN, *parts]) + "\n", encoding="utf-8")
    return path
