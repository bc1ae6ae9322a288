// Quantile of Student's t by the incomplete beta function, and the parts of an uncertainty.

const NORMAL = 1.959963984540054;
const TAIL = 0.025;

// Gamma(x + 1/2) / Gamma(x), by its series for a great x and the step from x to x + 1.
function gammaRatio(x) {
  let factor = 1;
  while (x < 40) {
    factor *= x / (x + 0.5);
    x += 1;
  }
  const s = 1 / x;
  const series = 1 + s * (-1 / 8 + s * (1 / 128 + s * (5 / 1024 + s * (-21 / 32768
    + s * (-399 / 262144 + s * (869 / 4194304))))));
  return factor * Math.sqrt(x) * series;
}

// Share of Student's distribution above t, by a continued fraction (Lentz).
function tailOf(t, freedom) {
  const a = freedom / 2, b = 0.5, x = freedom / (freedom + t * t);
  const front = Math.exp(-a * Math.log1p((t * t) / freedom)) * Math.sqrt((t * t) / (freedom + t * t))
    * gammaRatio(a) / Math.sqrt(Math.PI) / a;
  let c = 1, d = 1 - ((a + b) * x) / (a + 1);
  d = 1 / d;
  let h = d;
  for (let m = 1; m < 2000; m += 1) {
    let term = (m * (b - m) * x) / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / (1 + term * d);
    c = 1 + term / c;
    h *= d * c;
    term = (-(a + m) * (a + b + m) * x) / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / (1 + term * d);
    c = 1 + term / c;
    h *= d * c;
    if (Math.abs(d * c - 1) < 1e-16) break;
  }
  return (front * h) / 2;
}

// Coverage factor of 95 %; fewer degrees of freedom than one count as one.
function coverageFactor(freedom) {
  if (Number.isNaN(freedom)) return NaN;
  const nu = Math.min(Math.max(freedom, 1), 1e9);
  if (nu > 2000) {
    const z = NORMAL, z2 = z * z;
    return z * (1 + (z2 + 1) / (4 * nu) + (5 * z2 ** 2 + 16 * z2 + 3) / (96 * nu ** 2)
      + (3 * z2 ** 3 + 19 * z2 ** 2 + 17 * z2 - 15) / (384 * nu ** 3)
      + (79 * z2 ** 4 + 776 * z2 ** 3 + 1482 * z2 ** 2 - 1920 * z2 - 945) / (92160 * nu ** 4));
  }
  // the tail is convex: from below, Newton's steps never go too far
  let t = NORMAL;
  for (let step = 0; step < 60; step += 1) {
    const density = (gammaRatio(nu / 2) / Math.sqrt(nu * Math.PI))
      * Math.exp((-(nu + 1) / 2) * Math.log1p((t * t) / nu));
    const change = (tailOf(t, nu) - TAIL) / density;
    t += change;
    if (Math.abs(change) < 1e-15 * t) break;
  }
  return t;
}

function sumOf(values) {
  return values.reduce((total, one) => total + one, 0);
}

function squares(values) {
  return sumOf(values.map((one) => one * one));
}

// Root of the sum of squares of shared errors and of the random part.
function combined(rows, random) {
  return Math.sqrt(squares(rows) + random * random);
}

// Degrees of freedom of a combined uncertainty (Welch and Satterthwaite).
function effectiveFreedom(random, freedom, rows, ofRows) {
  if (Number.isNaN(random)) return NaN;
  const parts = rows.map((one) => (Number.isNaN(one) ? 0 : one));
  const total = random * random + squares(parts);
  if (!(total > 0)) return Infinity;
  const few = ((random * random) / total) ** 2 / freedom
    + sumOf(parts.map((one, place) => ((one * one) / total) ** 2 / ofRows[place]));
  return 1 / few;
}
