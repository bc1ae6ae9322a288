// One monotone curve, begun at zero and thinned to few points with a stated error.

const LIFT = 1e-6, LEAST_OF_GREATEST = 1e-3, MOST_ROWS = 30;

function stepsBetween(values) {
  return values.slice(1).map((one, place) => one - values[place]);
}

// The curve from 0 0, strictly rising, and what was added.
function curveFromZero(strain, tension) {
  if (strain.length < 2) {
    throw new Refusal("a curve has not two points or more",
      { found: `(${strain.length},) strains, (${tension.length},) tensions` });
  }
  const back = stepsBetween(strain).map((one, place) => one <= 0 || tension[place + 1] - tension[place] < 0);
  if (back.some(Boolean)) {
    const first = back.indexOf(true);
    throw new Refusal(`a curve turns back at ${back.filter(Boolean).length} of ${back.length} steps: a loop is `
      + "not exported", {
      found: `strain ${plainNumber(strain[first], 6)} to ${plainNumber(strain[first + 1], 6)}, tension `
        + `${plainNumber(tension[first], 6)} to ${plainNumber(tension[first + 1], 6)} N after point ${first + 1}`,
      needed: "one branch, or a mean: strain rising, tension not falling",
    });
  }
  const atNone = tension.filter((load, place) => strain[place] <= 0 && load > 0);
  if (atNone.length) {
    const least = Math.max(...strain.filter((one) => one <= 0));
    throw new Refusal("a curve has tension where it has no strain", {
      found: `${plainNumber(Math.max(...tension.filter((_, place) => strain[place] <= 0)), 6)} N at strain ${plainNumber(least, 6)}`,
      needed: "strain of the length at zero tension",
    });
  }
  const kept = tension.map((load) => load > 0);
  if (!kept.some(Boolean)) {
    throw new Refusal("a curve ends at no tension", { found: `${plainNumber(tension[tension.length - 1], 6)} N` });
  }
  const slack = strain.filter((one, place) => one > 0 && !kept[place]);
  const ofKept = (values) => values.filter((_, place) => kept[place]);
  let at, load, words;
  if (slack.length) {
    const last = slack[slack.length - 1];
    at = [0, last, ...ofKept(strain)];
    load = [0, 0, ...ofKept(tension)];
    words = `slack from 0 0 to strain ${plainNumber(last, 6)}`;
  } else {
    at = [0, ...ofKept(strain)];
    load = [0, ...ofKept(tension)];
    words = strain.some((one, place) => one === 0 && !kept[place]) ? ""
      : `a straight line from 0 0 to the first point at strain ${plainNumber(at[1], 6)}`;
  }
  const last = load.length - 1;
  if (stepsBetween(load).some((step) => step <= 1e-12 * load[last])) {
    const lift = LIFT * load[last];
    load = load.map((one, place) => one + (lift * at[place]) / at[last]);
    const added = `${plainNumber(LIFT, 6)} of the greatest tension added over the strain, where it did not rise`;
    words = words ? `${words}; ${added}` : added;
  }
  return [at, load, words];
}

// Points whose chords stay within the tolerances; none where they are too many.
function pointsWithin(at, load, tolerance) {
  const chosen = [0], last = at.length - 1;
  while (chosen[chosen.length - 1] < last) {
    if (chosen.length === MOST_ROWS) return null;
    const here = chosen[chosen.length - 1];
    let steepest = Infinity, flattest = -Infinity, reached = here + 1;
    for (let place = here + 1; place <= last; place += 1) {
      const run = at[place] - at[here], rise = load[place] - load[here], slope = rise / run;
      steepest = Math.min(steepest, (rise + tolerance[place]) / run);
      flattest = Math.max(flattest, (rise - tolerance[place]) / run);
      if (slope >= flattest && slope <= steepest) reached = place;
    }
    chosen.push(reached);
  }
  return chosen;
}

// Points of the least share whose tolerances leave few enough, and that share.
function fewestPoints(at, load, allowed) {
  let chosen = [0, at.length - 1], low = 0, high = 1 / LEAST_OF_GREATEST;
  for (let time = 0; time < 56; time += 1) {
    const middle = Math.max((low + high) / 2, 1e-12), found = pointsWithin(at, load, allowed(middle));
    if (found === null) {
      low = middle;
    } else {
      chosen = found;
      high = middle;
    }
  }
  return [chosen, high];
}

function thinCurve(strain, tension) {
  const [at, load, words] = curveFromZero(strain, tension);
  const high = load[load.length - 1];
  let chosen = at.map((_, place) => place);
  if (at.length > MOST_ROWS) {
    const scale = load.map((one) => Math.max(one, LEAST_OF_GREATEST * high));
    const [first, least] = fewestPoints(at, load, (share) => scale.map((one) => share * one));
    const near = scale.map((one) => Math.max(0.01, 1.25 * least) * one);
    const [closer] = fewestPoints(at, load, (share) => near.map((one) => Math.min(share * high, one)));
    chosen = closer.length > 2 ? closer : first;
  }
  const written = (values) => chosen.map((place) => Number(general(values[place], 10)));
  let kept = written(at), held = written(load);
  if ([...stepsBetween(kept), ...stepsBetween(held)].some((step) => step <= 0)) {
    kept = chosen.map((place) => at[place]);
    held = chosen.map((place) => load[place]);
  }
  const last = kept.length - 1;
  let error = 0, local = 0;
  strain.forEach((given, place) => {
    if (given < 0) return;
    const there = given > kept[last] ? held[last] : interpolate(given, kept, held);
    const off = Math.abs(there - Math.max(tension[place], 0));
    error = Math.max(error, off);
    local = Math.max(local, off / Math.max(tension[place], LEAST_OF_GREATEST * high));
  });
  return {
    strain: kept, tension: held, error, share: error / high, words,
    local: `${scientific(local, 2)} of the tension there, or of ${plainNumber(LEAST_OF_GREATEST, 6)} of the greatest`,
  };
}
