// A design value of a line, as reduction.lines.line_lookup.look_up gives it, at one point.

const DASHPOT = "dashpot_coefficient", SPRING = "dissipation_spring_constant", TIME = "relaxation_time";

function distinct(values) {
  return [...new Set(values)];
}

function unitOf(name) {
  return DATA.quantities[name][0];
}

// Unit as it stands behind a number; a plain number has none.
function unitBehind(name) {
  return unitOf(name) === "1" ? "" : ` ${unitOf(name)}`;
}

function noBranch(quantity, line, branch) {
  return new Refusal(`${quantity} of ${line.name} does not differ by branch`,
    { found: branch, needed: "no branch" });
}

function lookUp(line, quantity, levels, { branch = null, flag = false } = {}) {
  if (quantity === DASHPOT && !(quantity in line.surfaces) && line.has_dashpot) {
    if (branch !== null) throw noBranch(quantity, line, branch);
    return dashpotOf(line, levels, flag);
  }
  const surface = line.surfaces[quantity];
  for (const [name, value] of Object.entries(levels)) {
    if (!Number.isFinite(value)) throw new Refusal(`${name} is not finite`, { needed: "numbers" });
    if (name === "frequency" && value <= 0) {
      throw new Refusal("a frequency is not positive",
        { found: `${plainNumber(value, 5)} Hz`, needed: "above zero" });
    }
  }
  if (surface && line.factors.every((name) => name in levels)) {
    if (branch !== null) throw noBranch(quantity, line, branch);
    return valuesOfSurface(line, surface, levels, flag);
  }
  const known = line.curves.filter((one) => one.quantity === quantity);
  if (!known.length && !surface) {
    const why = line.absent[quantity];
    throw new Refusal(`${line.name} has no ${quantity}${why ? `: ${why}` : ""}`,
      { needed: `one of ${line.quantities.join(", ")}` });
  }
  const curves = known.filter((one) => one.variable in levels);
  if (!curves.length) {
    const needed = [...(surface ? [line.factors.join(", ")] : []), ...known.map((one) => one.variable)];
    throw new Refusal(`${quantity} of ${line.name} needs another variable`,
      { found: Object.keys(levels).join(", ") || "none", needed: distinct(needed).join(" or ") });
  }
  return valuesOfCurve(line, curveOfBranch(line, curves, branch), levels, flag);
}

function curveOfBranch(line, curves, branch) {
  if (branch !== null && !curves.some((one) => one.branch)) {
    throw noBranch(curves[0].quantity, line, branch);
  }
  // where one branch alone is known it need not be asked for
  const found = curves.filter((one) => branch === null || one.branch === branch);
  if (found.length === 1) return found[0];
  throw new Refusal(`${curves[0].quantity} of ${line.name} differs by branch`, {
    found: branch || "no branch",
    needed: `branch = ${curves.map((one) => one.branch).filter(Boolean).join(" or ")}`,
  });
}

function onlyLevels(line, quantity, levels, allowed, needed) {
  const unknown = Object.keys(levels).filter((name) => !allowed.includes(name)).sort();
  if (unknown.length) {
    throw new Refusal(`${quantity} of ${line.name} does not vary with ${unknown.join(", ")}`,
      { needed });
  }
}

const FLAG_HINT = "--extrapolate flag gives the number, where there is one, and flags it.";

function valuesOfSurface(line, surface, levels, flag) {
  onlyLevels(line, surface.quantity, levels, line.factors, `levels of ${line.factors.join(", ")}`);
  const at = line.factors.map((name) => levels[name]);
  const points = pointsOfSurface(surface, at);
  if (!flag && !points.inside) {
    const told = line.factors.flatMap((name, place) => {
      const [value, low, high] = [at[place], surface.low[place], surface.high[place]];
      const rounded = surface.rounding.length ? surface.rounding[place] : 0;
      if (low - rounded <= value && value <= high + rounded) return [];
      const unit = unitOf(name);
      return [`${name} ${plainNumber(value, 5)} ${unit}, tested ${plainNumber(low, 5)} to ${plainNumber(high, 5)} ${unit}`];
    });
    throw new Refusal(`outside the tested range of ${surface.quantity} of ${line.name}: 1 of 1 points`, {
      found: told.join("; "),
      needed: "levels inside the tested range",
      hint: FLAG_HINT,
    });
  }
  const hasInterval = Number.isFinite(surface.sigma);
  const words = hasInterval ? ["one more run of the same specimens", "the surface of these specimens"] : ["", ""];
  return told(line, surface, points, {
    loads: loadsOfLine(line, levels), words, more: [],
    is_untested: points.inside && points.leverage > DATA.above_leverage * surface.greatest_leverage,
    freedom: points.freedom,
  });
}

function valuesOfCurve(line, curve, levels, flag) {
  onlyLevels(line, curve.quantity, levels, [curve.variable], `levels of ${curve.variable}`);
  const x = levels[curve.variable];
  const points = evaluateCurve(curve, x);
  if (!flag && !points.inside) {
    const unit = unitBehind(curve.variable);
    const gaps = curve.gaps.filter(([low, high]) => low < x && x < high)
      .map(([low, high]) => `, nothing between ${plainNumber(low, 5)} and ${plainNumber(high, 5)}`).join("");
    throw new Refusal(`outside the tested range of ${curve.quantity} of ${line.name}: 1 of 1 points`, {
      found: `${curve.variable} ${plainNumber(x, 5)}${unit}`,
      needed: `${plainNumber(curve.low, 5)} to ${plainNumber(curve.high, 5)}${unit}${gaps}`,
      hint: [curve.range_note, FLAG_HINT].filter(Boolean).join(". "),
    });
  }
  const spread = curve.standard_uncertainty.length ? curve.spread_of : "";
  const none = Object.fromEntries(["low", "high", "kind_low", "kind_high", "line_low", "line_high"]
    .map((name) => [name, NaN]));
  const found = {
    ...points, ...none, surface_low: points.value - points.half, surface_high: points.value + points.half,
  };
  return told(line, curve, found, {
    loads: loadsOfLine(line, levels, curve.branch), words: ["", spread], is_untested: false,
    more: [...(curve.range_note ? [curve.range_note] : []), ...jointsOf(curve, x)], freedom: points.freedom,
  });
}

// Where two pieces meet with two values, and the point is just there.
function jointsOf(curve, x) {
  return curve.value.flatMap((below, place) => {
    const above = curve.value[place + 1];
    const meet = place + 1 < curve.at.length && curve.at[place + 1] - curve.at[place] === 0
      && above - below !== 0 && x === curve.at[place];
    return meet ? [`at ${curve.variable} ${plainNumber(curve.at[place], 5)} two pieces meet: `
      + `${plainNumber(below, 4)}${unitBehind(curve.quantity)} below, ${plainNumber(above, 4)} above`] : [];
  });
}

// Numbers with what has to be told of them.
function told(line, of, points, { loads, words, more, is_untested, freedom }) {
  const notes = [...line.notes, ...of.notes, ...more];
  const isCurve = "variable" in of;
  if (words[0] || words[1]) {
    notes.push(!isCurve && Number.isFinite(of.line_scatter)
      ? `specimens of this kind scatter by about ${(100 * of.line_scatter).toFixed(0)} % `
        + "(CG-D-39-80, sec. 4.4.1): included only in the intervals of the kind and of another "
        + "specimen"
      : `the interval applies to ${words[0] || words[1]}; scatter between specimens is not included`);
  } else if (isCurve) {
    notes.push("no interval is given: the source does not state the scatter of this curve");
  }
  if (loads.is_above_rule) notes.push(`the peak tension exceeds the limit of the source: ${line.rule}`);
  if (loads.is_slack && loads.peak > 0) {
    notes.push("the minimum is zero: a snap load, which breaks fibres (CG-D-39-80, sec. 5.0)");
  }
  if (points.value < 0) {
    notes.push(`1 of 1 values is negative, which ${of.quantity} cannot be: the surface is not valid there`);
  }
  return {
    ...points, ...loads, is_untested, freedom,
    quantity: of.quantity, unit: unitOf(of.quantity), component: of.component,
    rule: line.rule, source: line.source, errata: of.errata, notes: distinct(notes), warnings: of.warnings ?? [],
    branch: of.branch || "", interval_of: words[0], surface_interval_of: words[1],
  };
}

function halfWidthOfParts(own, few, rows = [], ofRows = []) {
  const parts = [...own, ...rows];
  return coverageFactor(effectiveFreedom(0, Infinity, parts, [...few, ...ofRows])) * combined(parts, 0);
}

// Half width of an interval without the errors that the value shares with others.
function ownHalfWidth(found, end) {
  const half = Math.abs(found[end] - found.value);
  if (!found.component.length) return half;
  if (!found.is_apart) {
    return Math.sqrt(Math.max(half ** 2 - (1.96 * Math.sqrt(squares(found.contribution))) ** 2, 0));
  }
  const isOfSurface = end.startsWith("surface") || end.startsWith("kind");
  const random = isOfSurface ? found.random : found.run;
  const within = Math.abs(found[`${isOfSurface ? "surface_" : ""}${end.split("_").pop()}`] - found.value);
  const alone = halfWidthOfParts([random], [found.freedom]);
  const both = halfWidthOfParts([random], [found.freedom], found.contribution,
    found.component.map((one) => one[3]));
  // far outside the tested range an interval has no end, and its parts are not known
  const own = within * (both > 0 ? alone / both : 1);
  const between = Number.isFinite(half) ? half ** 2 - within ** 2 : half;
  return Math.sqrt(Math.max(between, 0) + own ** 2);
}

// Whether the parts are known and the interval reaches as far to either side.
function isEven(found) {
  if (!found.is_apart) return false;
  const up = found.surface_high - found.value, down = found.value - found.surface_low;
  return (Number.isNaN(up) && Number.isNaN(down)) || Math.abs(up - down) <= 1e-6 * Math.abs(down);
}

// N = K_1 tau: what both share by its sign, what is of each alone as independent.
function dashpotOf(line, levels, flag) {
  const [spring, time] = [SPRING, TIME].map((name) => lookUp(line, name, levels, { flag }));
  const shared = new Map();
  [[spring, time.value], [time, spring.value]].forEach(([one, by]) => {
    one.component.forEach(([source, of, number, freedom], place) => {
      const key = JSON.stringify([source, of, number]);
      const [sum, few] = shared.get(key) ?? [0, freedom];
      shared.set(key, [sum + one.contribution[place] * by, few]);
    });
  });
  const rows = [...shared.values()].map((one) => one[0]), few = [...shared.values()].map((one) => one[1]);
  const isEvenBoth = isEven(spring) && isEven(time);
  const half = (end) => {
    if (isEvenBoth) {
      const part = end.startsWith("surface") ? "random" : "run";
      return halfWidthOfParts([spring[part] * time.value, time[part] * spring.value],
        [spring.freedom, time.freedom], rows, few);
    }
    const own = [ownHalfWidth(spring, end) * time.value, ownHalfWidth(time, end) * spring.value];
    return Math.sqrt(squares(own) + (1.96 * Math.sqrt(squares(rows))) ** 2);
  };
  const value = spring.value * time.value;
  return {
    ...spring, quantity: DASHPOT, unit: unitOf(DASHPOT), value,
    low: value - half("low"), high: value + half("high"),
    surface_low: value - half("surface_low"), surface_high: value + half("surface_high"),
    errata: distinct([...spring.errata, ...time.errata]),
    notes: distinct(["N = K_1 tau; the intervals treat the scatter of the two as independent and "
      + "include the errors that the runs share", ...spring.notes, ...time.notes]),
  };
}
