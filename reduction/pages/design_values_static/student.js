// Quantile of Student's t out of a table, and the parts of an uncertainty.

// Coverage factor of 95 %; fewer degrees of freedom than one count as one. A polynomial through the
// six rows about it, which stand at equal steps of 1 / freedom from none to one: within 1e-8.
function coverageFactor(freedom) {
  if (Number.isNaN(freedom)) return NaN;
  const rows = DATA.coverage_factors, last = rows.length - 1, near = 6;
  const at = last / Math.max(freedom, 1);
  const first = Math.min(Math.max(Math.floor(at) - near / 2 + 1, 0), last + 1 - near);
  const places = Array.from({ length: near }, (_, place) => first + place);
  return sumOf(places.map((own) => (
    places.reduce((share, other) => (other === own ? share : (share * (at - other)) / (own - other)), rows[own]))));
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
