"""Instruments: what a campaign states of its errors, the errors drawn from that, and channels."""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from strangers.campaign import Inline
from strangers.materials import Array, stop

SI = {
    "ft": 0.3048,
    "in": 0.0254,
    "m": 1.0,
    "mm": 1e-3,
    "cm": 1e-2,
    "lbf": 4.4482216152605,
    "N": 1.0,
    "kN": 1e3,
    "%": 0.01,
    "1": 1.0,
    "ms": 1e-3,
    "s": 1.0,
    "kg": 1.0,
    "m/N": 1.0,
}
Form = Literal["standard", "half_width", "expanded"]


@dataclass(frozen=True)
class Statement:
    """One stated error: a standard uncertainty, a half width (uniform) or an expanded one (k = 2).

    ``one_sided`` draws the magnitude only (a lag is never negative): half-normal or uniform from
    zero, of the same root mean square about zero as what is stated.
    """

    size: float
    unit: str
    form: Form = "standard"
    one_sided: bool = False

    @property
    def standard(self) -> float:
        """Standard uncertainty in the unit of the statement."""
        return self.size / {"standard": 1.0, "half_width": 1.7320508, "expanded": 2.0}[self.form]

    def draw(self, rng: np.random.Generator) -> float:
        """Draw one error, in the unit of the statement."""
        if self.form == "half_width":
            error = float(rng.uniform(-self.size, self.size))
        else:
            error = float(rng.normal(0.0, self.standard))
        return abs(error) if self.one_sided else error

    def toml(self) -> str | Inline:
        """Return the statement as campaign.toml writes it."""
        text = f"{self.size:.6g} {self.unit}"
        if self.form == "half_width":
            return Inline(half_width=text)
        if self.form == "expanded":
            return Inline(expanded=text, k=2)
        return text


@dataclass
class ErrorBook:
    """The stated and the drawn errors of a campaign."""

    rng: np.random.Generator
    entries: dict[str, dict[str, float | str]] = field(default_factory=dict)

    def draw(self, name: str, statement: Statement) -> float:
        """Draw an error in SI (a fraction for "%") and keep it with its statement."""
        drawn = statement.draw(self.rng)
        self.note(name, statement, drawn)
        return drawn * SI[statement.unit]

    def note(self, name: str, statement: Statement, drawn: float) -> None:
        """Keep an error that was drawn elsewhere (in the unit of its statement)."""
        self.entries[name] = {
            "form": statement.form,
            "stated": statement.size,
            "stated_standard": statement.standard,
            "drawn": drawn,
            "unit": statement.unit,
        }


def rounded(value: float, digits: int = 3) -> float:
    """Round to significant digits, as a person would state a number."""
    return float(f"{value:.{digits}g}")


@dataclass(frozen=True)
class Channel:
    """A logged channel: unit, noise and quantum in that unit, gain and offset errors in SI."""

    unit: str
    noise: float
    quantum: float
    gain_error: float = 0.0
    offset_error: float = 0.0
    play: float = 0.0  # full width of the backlash, SI

    @property
    def standard_uncertainty(self) -> float:
        """Noise, quantum and play together, in the unit of the channel, rounded up a little."""
        play = self.play / SI[self.unit]
        total = (self.noise**2 + self.quantum**2 / 12.0 + play**2 / 12.0) ** 0.5
        return rounded(total * 1.005, 3)

    def read(self, true: Array, rng: np.random.Generator, drift: Array | float = 0.0) -> Array:
        """Return logged values, in the unit of the channel, of true values in SI."""
        seen = true - stop(true - true[0], self.play / 2.0) if self.play > 0.0 else true
        value = (seen * (1.0 + self.gain_error) + self.offset_error + drift) / SI[self.unit]
        value = value + rng.normal(0.0, self.noise, value.shape)
        if self.quantum <= 0.0:
            return value
        return np.round(value / self.quantum) * self.quantum
