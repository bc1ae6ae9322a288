// A quadratic surface at a point, with its intervals.

const EDGE = 1e-9;

// Response on its own scale: the median where the transformed one is normal.
function backTransform(value, exponent) {
  if (exponent === 0) return Math.exp(value);
  const base = Math.max(1 + exponent * value, 0);
  if (Number.isNaN(value)) return NaN;
  if (base === 0 && exponent < 0) return Infinity;
  return base ** (1 / exponent);
}

// What a small change on the transformed scale is of the response.
function backTransformedChange(value, change, exponent) {
  const half = (backTransform(value + change, exponent) - backTransform(value - change, exponent)) / 2;
  return Number.isFinite(half) ? half : NaN;
}

// Products of powers of coded levels.
function termsOf(exponents, coded) {
  return exponents.map((powers) => {
    let term = 1;
    powers.forEach((power, j) => {
      for (let time = 0; time < power; time += 1) term *= coded[j];
    });
    return term;
  });
}

// Standard uncertainty of what a quadratic may miss at a point; none where the runs are not known.
function missedAt(surface, coded) {
  const terms = termsOf(surface.discrepancy_exponents, coded);
  const square = sumOf(surface.discrepancy.map((row, place) => (
    terms[place] * sumOf(row.map((moment, other) => moment * terms[other])))));
  return Math.sqrt(Math.max(square, 0));
}

function evaluateSurface(surface, at, choice = {}) {
  const low = choice.low ?? surface.low, high = choice.high ?? surface.high;
  const coefficient = choice.coefficient ?? surface.coefficient;
  const coded = at.map((x, j) => (x - (high[j] + low[j]) / 2) / ((high[j] - low[j]) / 2));
  const terms = termsOf(surface.exponents, coded);
  const dot = (other) => sumOf(terms.map((term, place) => term * other[place]));
  const leverage = dot(terms.map((_, place) => dot(surface.covariance_factor.map((row) => row[place]))));
  const centre = dot(coefficient);
  const rows = surface.component.length ? surface.contribution.map(dot) : [];
  const few = surface.component.map((one) => one[3]);
  const sigma = surface.degrees_of_freedom > 0 ? surface.sigma : NaN;
  const missed = missedAt(surface, coded);
  const withMissed = (scatter) => [Math.hypot(scatter, missed), effectiveFreedom(
    scatter, surface.degrees_of_freedom, [missed], [surface.discrepancy_degrees_of_freedom])];
  const [random, freedom] = withMissed(sigma * Math.sqrt(leverage));
  const [run, runFreedom] = withMissed(sigma * Math.sqrt(1 + leverage));
  const halfOf = (part, own) => (rows.length
    ? coverageFactor(effectiveFreedom(part, own, rows, few)) * combined(rows, part)
    : coverageFactor(own) * part);
  const half = halfOf(run, runFreedom), own = halfOf(random, freedom);
  const rounded = surface.rounding.length ? surface.rounding : at.map(() => 0);
  const found = {
    value: centre, low: centre - half, high: centre + half, surface_low: centre - own,
    surface_high: centre + own, leverage, random, freedom, run, contribution: rows,
    inside: coded.every((x, j) => Math.abs(x) <= 1 + EDGE + (2 * rounded[j]) / (high[j] - low[j])),
  };
  if (surface.exponent !== 1) {
    const back = (change) => backTransformedChange(centre, change, surface.exponent);
    found.contribution = rows.map(back);
    found.random = back(random);
    found.run = back(run);
    for (const name of ["value", "low", "high", "surface_low", "surface_high"]) {
      found[name] = backTransform(found[name], surface.exponent);
    }
  }
  if (surface.frequency_column !== null) {
    const frequency = at[surface.frequency_column];
    found.contribution = found.contribution.map((one) => one / frequency);
    for (const name of ["value", "low", "high", "surface_low", "surface_high", "random", "run"]) {
      found[name] /= frequency;
    }
  }
  return found;
}

// Least and greatest where one that is no number makes none of both.
function leastOf(values) {
  return values.some(Number.isNaN) ? NaN : Math.min(...values);
}

function greatestOf(values) {
  return values.some(Number.isNaN) ? NaN : Math.max(...values);
}

// 95 % of the mean of all lines of a kind, or of one more of them.
function betweenLines(value, low, high, surface, isAnother) {
  if (!(Number.isFinite(surface.line_scatter) && surface.n_lines > 0)) return [NaN, NaN];
  const share = (isAnother ? 1 : 0) + 1 / surface.n_lines;
  const own = coverageFactor(surface.degrees_of_freedom)
    * Math.sqrt(Math.log1p(surface.line_scatter ** 2) * share);
  const known = value > 0 ? value : NaN;
  const [down, up] = [low, high].map((end) => Math.sqrt(own ** 2 + ((end - value) / known) ** 2));
  return [leastOf([known * Math.exp(-down), low]), greatestOf([known * Math.exp(up), high])];
}

// Value and intervals of a surface, which span coefficients and levels that are open.
function pointsOfSurface(surface, at) {
  const points = evaluateSurface(surface, at);
  const boxes = [[surface.low, surface.high], ...surface.alternative_boxes];
  const choices = boxes.flatMap(([low, high]) => [surface.coefficient, ...surface.alternatives]
    .map((coefficient) => ({ low, high, coefficient })));
  const others = choices.slice(1).map((choice) => evaluateSurface(surface, at, choice));
  const span = (name, end) => end([points, ...others].map((one) => one[name]));
  const found = {
    ...points,
    low: span("low", leastOf), high: span("high", greatestOf),
    surface_low: span("surface_low", leastOf), surface_high: span("surface_high", greatestOf),
    // where other surfaces may be the right one the interval is not of two parts
    is_apart: surface.component.length > 0 && others.length === 0,
  };
  [found.kind_low, found.kind_high] = betweenLines(
    found.value, found.surface_low, found.surface_high, surface, false);
  [found.line_low, found.line_high] = betweenLines(found.value, found.low, found.high, surface, true);
  return found;
}
