// K_1 and tau of a line from K_ap, H and K_0, how well they are known, and the line forwards.

function identifyByAmplitude(apparent, energy, amplitude, frequency, rest) {
  const loop = [apparent, energy, amplitude, frequency];
  let reason = loop.some(Number.isNaN) ? 3 : loop.every((one) => one > 0 && one < Infinity) ? 0 : 4;
  let lost = NaN, stored = NaN;
  if (reason === 0) {
    lost = (energy * apparent ** 2) / (Math.PI * amplitude ** 2);
    if (!(lost < apparent)) reason = 5;
    else if (!(lost > 0)) reason = 4;
    else stored = Math.sqrt((apparent - lost) * (apparent + lost));
  }
  if (reason === 0) {
    if (Number.isNaN(rest)) reason = 1;
    else if (!(rest > 0 && rest < Infinity)) reason = 2;
    else if (!(stored > rest)) reason = 6;
  }
  if (reason) return { reason, spring: NaN, time: NaN, stored, lost };
  const excess = stored - rest, turn = excess / lost;
  return {
    reason, stored, lost, spring: excess + lost / turn, time: turn / (2 * Math.PI * frequency),
  };
}

// Relative change of K_1 and tau for one of K_ap, H and K_0.
function sensitivitiesOf(stored, lost, rest) {
  const excess = stored - rest;
  const ofExcess = [stored / excess, 0, -rest / excess], ofTurn = [ofExcess[0], -1, ofExcess[2]];
  const share = 2 / (1 + (excess / lost) ** 2);
  const spring = ofExcess.map((one, place) => one - share * ofTurn[place]);
  const wide = (lost / stored) ** 2;
  const ofLost = [2, 1], ofStored = [1 + wide - wide * 2, -wide];
  const whole = (row) => [...ofLost.map((one, place) => row[0] * ofStored[place] + row[1] * one), row[2]];
  return { spring: whole(spring), time: whole(ofTurn) };
}

// Half widths of 95 % of K_1 and tau, from values whose errors are their own.
function halfWidths(line, rest, apparent, energy) {
  const slopes = sensitivitiesOf(line.stored, line.lost, rest.value);
  const relative = [apparent, energy, rest].map((found, place) => {
    const own = ownHalfWidth(found, "surface_high");
    return (place === 2 && Number.isNaN(own) ? 0 : own) / found.value;
  });
  const half = (name) => line[name] * Math.sqrt(squares(slopes[name].map((one, place) => one * relative[place])));
  return { spring: half("spring"), time: half("time") };
}

// A spring K_0 beside a spring K_1 in series with a dashpot, as an export holds it.
class Viscoelasticity {
  constructor(rest, spring, time, { mean = NaN, holds = "", frequency = NaN } = {}) {
    const dynamic = rest + spring, dashpot = spring * time;
    const all = [rest, dynamic, dashpot, 0];
    if (!all.every(Number.isFinite) || Math.min(...all) < 0) {
      throw new Refusal("stiffness and damping of a line are not numbers of at least zero",
        { found: all.map((one) => plainNumber(one, 6)).join(", ") });
    }
    if (!(dynamic > rest && rest > 0)) {
      throw new Refusal("the dynamic stiffness is not above the static one", {
        found: `${plainNumber(dynamic, 6)} N and ${plainNumber(rest, 6)} N`,
        needed: "a static stiffness above zero and a dynamic one above that",
      });
    }
    Object.assign(this, { rest, fast: dynamic, dashpot, mean, holds, frequency });
    Object.assign(this, { alpha: dynamic, slope: 0, growth: "" });
  }

  get spring() { return this.fast - this.rest; }

  get time() { return this.dashpot / (this.fast - this.rest); }

  get slowDashpot() {
    const share = this.fast / (this.fast - this.rest);
    return this.dashpot * share ** 2;
  }

  storedAndLost(frequency) {
    const turn = 2 * Math.PI * frequency * this.time, share = 1 / (1 + turn ** 2);
    return [this.rest + this.spring * (turn ** 2 * share), this.spring * (turn * share)];
  }

  apparentAt(frequency) {
    return Math.hypot(...this.storedAndLost(frequency));
  }

  get apparent() {
    return Number.isFinite(this.frequency) ? this.apparentAt(this.frequency) : this.fast;
  }

  energyAt(frequency, amplitude) {
    const [stored, lost] = this.storedAndLost(frequency);
    return (Math.PI * amplitude ** 2 * lost) / (stored ** 2 + lost ** 2);
  }
}
