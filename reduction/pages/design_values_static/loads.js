// Peak and minimum tension of a cycle, and the rule of the source for how high or low it may go.

const LOADED_SHARE = 0.6, SLACK_SHARE = 0.3, LEAST_SHARE = 0.03;

// What the look-up of the package refuses, in its words.
class Refusal extends Error {
  constructor(problem, { found = null, needed = null, hint = null } = {}) {
    const text = [problem, found === null ? null : `found ${found}`,
      needed === null ? null : `needed ${needed}`].filter((one) => one !== null).join("; ");
    super(hint ? `${text}. ${hint}` : text);
    Object.assign(this, { problem, found, needed, hint });
  }
}

function cycleLoads(mean, amplitude, line) {
  if (amplitude < 0) throw new Refusal("an amplitude is negative", { found: `${plainNumber(amplitude, 6)} N` });
  const least = mean - amplitude;
  if (least < -EDGE * Math.max(mean, 1)) {
    throw new Refusal(
      "1 of 1 amplitudes are above their mean tension: the line goes slack, which no surface describes",
      {
        found: `${plainNumber(amplitude, 4)} N about ${plainNumber(mean, 4)} N`,
        needed: "an amplitude of at most the mean",
      });
  }
  const peak = mean + amplitude, minimum = Math.max(least, 0);
  const strength = Number.isFinite(line.tensile_strength) ? line.tensile_strength : line.rated_break_strength;
  const ownPeak = peak / strength, ownMinimum = minimum / strength;
  const isLow = ownMinimum < LEAST_SHARE * (1 - EDGE);
  return {
    peak, minimum,
    peak_share: peak / line.rated_break_strength, minimum_share: minimum / line.rated_break_strength,
    own_peak_share: ownPeak, own_minimum_share: ownMinimum,
    is_slack: minimum <= EDGE * peak,
    is_above_rule: ownPeak > (isLow ? SLACK_SHARE : LOADED_SHARE) * (1 + EDGE),
  };
}

// The tension where there is no cycle; none where it is not known.
function oneTension(line, levels, branch) {
  for (const name of ["tension", "mean_tension"]) {
    if (name in levels) {
      if (levels[name] < 0) {
        throw new Refusal(`${name} is negative`, { found: `${plainNumber(levels[name], 4)} N` });
      }
      return levels[name];
    }
  }
  const curve = "strain" in levels
    && line.curves.find((one) => one.quantity === "branch_tension" && one.branch === branch);
  return curve ? Math.max(evaluateCurve(curve, levels.strain).value, 0) : NaN;
}

function loadsOfLine(line, levels, branch = "") {
  const isCycle = "mean_tension" in levels && "tension_amplitude" in levels;
  const mean = isCycle ? levels.mean_tension : oneTension(line, levels, branch);
  let loads = cycleLoads(Number.isNaN(mean) ? 0 : mean, isCycle ? levels.tension_amplitude : 0, line);
  if (Number.isNaN(mean)) {
    const none = ["peak", "minimum", "peak_share", "minimum_share", "own_peak_share", "own_minimum_share"];
    loads = { ...loads, ...Object.fromEntries(none.map((name) => [name, NaN])), is_slack: false };
  }
  if (line.is_tether) {
    if (loads.is_slack) {
      throw new Refusal(`${line.name} goes slack at 1 of 1 points, which a tether must not`, {
        found: `a minimum tension of zero, peak ${plainNumber(loads.peak, 4)} N`,
        needed: "a minimum above zero",
        hint: "A slack tether tangles and is cut: choose more stretch or less amplitude.",
      });
    }
    loads = { ...loads, is_above_rule: false };
  }
  return loads;
}
