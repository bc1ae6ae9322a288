// A quantity over one variable: a polynomial as published, points as measured.

// As numpy.interp: straight lines, nothing beyond the ends; of two points at one place the last.
function interpolate(x, at, values) {
  const last = at.length - 1;
  if (!at.length || Number.isNaN(x) || x < at[0] || x > at[last]) return NaN;
  let low = 0, high = at.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (at[middle] <= x) low = middle + 1;
    else high = middle;
  }
  const place = low - 1;
  if (place === last || at[place] === x) return values[place];
  const slope = (values[place + 1] - values[place]) / (at[place + 1] - at[place]);
  return slope * (x - at[place]) + values[place];
}

function knownOf(at, values) {
  const places = at.map((_, place) => place).filter((place) => Number.isFinite(values[place]));
  return [places.map((place) => at[place]), places.map((place) => values[place])];
}

function polynomial(x, coefficient) {
  return coefficient.reduceRight((total, one) => one + total * x, 0);
}

function evaluateCurve(curve, x) {
  const width = EDGE * Math.max(Math.abs(curve.low), Math.abs(curve.high));
  const inside = x >= curve.low - width && x <= curve.high + width
    && curve.gaps.every(([low, high]) => x <= low + width || x >= high - width);
  const between = (values) => interpolate(x, ...knownOf(curve.at, values));
  let value;
  if (curve.is_inverse_slope) {
    const [, b, c, d] = curve.coefficient;
    const slope = b + x * (2 * c + x * 3 * d);
    value = slope > 0 ? 1 / slope : NaN;
  } else {
    value = curve.coefficient.length ? polynomial(x, curve.coefficient) : between(curve.value);
  }
  const few = curve.component.map((one) => one[3]);
  let random = NaN, freedom = NaN, rows = curve.component.map(() => 0);
  if (curve.standard_uncertainty.length) {
    const own = curve.standard_uncertainty.map((all, place) => Math.sqrt(Math.max(
      all * all - squares(curve.contribution.map((row) => row[place])), 0)));
    random = between(own);
    freedom = 1 / between(curve.degrees_of_freedom.length
      ? curve.degrees_of_freedom.map((one) => 1 / one) : curve.at.map(() => 0));
    rows = curve.contribution.map(between);
  }
  const half = coverageFactor(effectiveFreedom(random, freedom, rows, few)) * combined(rows, random);
  return { value, random, freedom, contribution: rows, half, inside };
}
