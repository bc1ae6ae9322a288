// K_0, K_1 and tau of a line for export, such that it gives back its own K_ap and H, and the words.

const REST = "quasi_static_spring_constant", APPARENT = "apparent_spring_constant";
const ENERGY = "hysteresis_energy", SPRING = "dissipation_spring_constant", TIME = "relaxation_time";

// Design value at those of the levels that the quantity varies with.
function valueAt(line, quantity, levels, flag) {
  const names = quantity in line.surfaces ? line.factors
    : line.curves.filter((one) => one.quantity === quantity).map((one) => one.variable);
  const given = {};
  for (const name of names) {
    if (name in levels || name === "tension") {
      given[name] = name === "tension" ? levels.mean_tension : levels[name];
    }
  }
  return lookUp(line, quantity, given, { flag });
}

function identified(rest, apparent, energy, levels) {
  return identifyByAmplitude(apparent.value, energy.value, levels.tension_amplitude, levels.frequency,
    rest.value);
}

function partOf(rest, spring, time, levels) {
  const holds = Object.entries(levels)
    .map(([name, value]) => `${name.replaceAll("_", " ")} ${plainNumber(value, 5)}`).join(", ");
  return new Viscoelasticity(rest.value, spring, time,
    { mean: levels.mean_tension, holds: `${holds} (SI)`, frequency: levels.frequency });
}

function lineDynamics(line, levels, flag) {
  const value = (name) => valueAt(line, name, levels, flag);
  const has = (...names) => names.every((name) => line.quantities.includes(name));
  const rest = value(REST);
  const measured = has(APPARENT, ENERGY) ? [value(APPARENT), value(ENERGY)] : [];
  const printed = has(SPRING, TIME) || !measured.length ? [value(SPRING), value(TIME)] : [];
  const { frequency, tension_amplitude: amplitude } = levels;
  let part, notes, isIdentified = false;
  if (measured.length) {
    const found = identified(rest, ...measured, levels);
    isIdentified = found.reason === 0;
    if (isIdentified) {
      const half = halfWidths(found, rest, ...measured);
      part = partOf(rest, found.spring, found.time, levels);
      notes = [
        saidIdentified(part, amplitude, half, !Number.isFinite(rest.surface_high)),
        saidPrinted(rest.value, printed, measured, frequency, amplitude),
        ...doubtsOfIdentified(found, half, measured[1]),
      ];
    } else {
      part = instead(line, rest, measured, printed, levels, found.reason);
      notes = [saidInstead(part, measured, amplitude, found.reason), ...doubtsOfPrinted(printed[1])];
    }
    notes.push(...overFrequency(line, part, levels));
  } else {
    part = partOf(rest, printed[0].value, printed[1].value, levels);
    notes = ["K_1 and tau are those of the source: it has no K_ap and H to hold them against",
      ...doubtsOfPrinted(printed[1])];
  }
  const [slope, growth] = growthOf(line, levels, part.fast, isIdentified);
  const every = [rest, ...measured, ...printed];
  for (const text of distinct(every.flatMap((one) => one.notes))) {
    if (!line.notes.includes(text)) {
      const of = every.filter((one) => one.notes.includes(text)).map((one) => one.quantity);
      notes.push(`${of.join(", ")}: ${text}`);
    }
  }
  Object.assign(part, { alpha: part.fast - slope * levels.mean_tension, slope, growth });
  return { part, sources: every.map(saidOfValue), notes: [...notes, growth] };
}

// Printed K_1 and tau, where K_ap of them is not to be told from that of the surface.
function instead(line, rest, [apparent, energy], printed, levels, reason) {
  const why = `no K_1 and tau of ${line.name} give back its K_ap and H there: ${DATA.reasons[reason]}`;
  const numbers = `K_0 ${plainNumber(rest.value, 5)} N, K_ap ${plainNumber(apparent.value, 5)} N, H `
    + `${plainNumber(energy.value, 4)} J/m`;
  if (!printed.length) throw new Refusal(why, { found: numbers, needed: "other levels" });
  const [spring, time] = printed.map((one) => one.value);
  if (!(spring > 0 && time > 0)) {
    throw new Refusal(`${why}; and the printed ones are not above zero`, {
      found: `K_1 ${plainNumber(spring, 4)} N, tau ${plainNumber(time, 4)} s; ${numbers}`, needed: "other levels",
    });
  }
  const part = partOf(rest, spring, time, levels), model = part.apparent;
  if (!(apparent.surface_low <= model && model <= apparent.surface_high)) {
    throw new Refusal(`${why}; and the printed ones give another K_ap than the line has`, {
      found: `K_ap ${plainNumber(model, 5)} N; ${numbers}`, needed: intervalOf(apparent),
      hint: "Another level, or the curve alone: leave the levels away.",
    });
  }
  return part;
}

function evenly(low, high, count) {
  const step = (high - low) / (count - 1);
  return Array.from({ length: count }, (_, place) => (place === count - 1 ? high : low + place * step));
}

function overFrequency(line, part, levels) {
  const surface = line.surfaces[APPARENT], place = line.factors.indexOf("frequency");
  if (!surface || place < 0) return [];
  const rows = evenly(surface.low[place], surface.high[place], 3).map((frequency) => {
    const found = valueAt(line, APPARENT, { ...levels, frequency }, true);
    const model = part.apparentAt(frequency), own = found.value;
    const isInside = found.surface_low <= model && model <= found.surface_high;
    const outside = isInside || Number.isNaN(found.surface_low) ? "" : ", OUTSIDE its interval";
    const share = own > 0 ? ` (${fixed(100 * (model / own - 1), 1, "+")} percent${outside})` : "";
    return `${plainNumber(frequency, 3)} Hz ${plainNumber(model, 5)} against ${plainNumber(own, 5)} N${share}`;
  });
  return ["one K_1 and tau do not hold at every frequency; K_ap of the exported line against the "
    + `surface at this mean tension and amplitude: ${rows.join(", ")}`];
}

// Slope of K_0 + K_1 over the mean tension, zero where none can be written, and words.
function growthOf(line, levels, fast, isIdentified) {
  const surface = line.surfaces[isIdentified ? APPARENT : SPRING];
  const place = line.factors.indexOf("mean_tension");
  if (!surface || place < 0) {
    return [0, "growth of the dynamic stiffness with the mean tension is not known"];
  }
  const low = Math.max(surface.low[place], levels.tension_amplitude ?? 0);
  const points = evenly(low, surface.high[place], 9)
    .map((mean) => [mean, totalAt(line, { ...levels, mean_tension: mean }, isIdentified)])
    .filter((one) => Number.isFinite(one[1]));
  if (points.length < 3) {
    return [0, "growth of the dynamic stiffness with the mean tension is not known: K_1 is found at "
      + `${points.length} of 9 means`];
  }
  const means = points.map((one) => one[0]), totals = points.map((one) => one[1]);
  const centre = sumOf(means) / means.length, level = sumOf(totals) / totals.length;
  const slope = sumOf(points.map(([x, y]) => (x - centre) * (y - level))) / squares(means.map((x) => x - centre));
  const worst = Math.max(...points.map(([x, y]) => Math.abs(slope * (x - centre) + level - y)));
  const words = `growth of the dynamic stiffness with the mean tension: ${plainNumber(slope, 4)}, a straight line `
    + `through ${means.length} of 9 means over the tested ones, off by up to ${plainNumber(worst, 3)} N, `
    + `${general((100 * worst) / fast, 2)} percent of EA_d`;
  if (slope * (Math.max(...means) - Math.min(...means)) < 1e-9 * Math.max(...totals.map(Math.abs))) {
    return [0, `${words}; it does not grow, and no slope is exported`];
  }
  if (fast - slope * levels.mean_tension <= 0) {
    return [0, `${words}; with it EA_d would be below zero at no tension, and no slope is exported: `
      + "the stiffness holds at this mean tension alone"];
  }
  return [slope, words];
}

function totalAt(line, levels, isIdentified) {
  const rest = valueAt(line, REST, levels, true);
  const spring = isIdentified
    ? identified(rest, valueAt(line, APPARENT, levels, true), valueAt(line, ENERGY, levels, true), levels).spring
    : valueAt(line, SPRING, levels, true).value;
  // a K_0 that is not trusted says nothing of the growth
  return rest.inside ? rest.value + spring : NaN;
}

function saidIdentified(part, amplitude, half, isExact) {
  const known = Number.isFinite(half.spring) && Number.isFinite(half.time)
    ? `; 95 percent of K_1 +-${plainNumber(half.spring, 3)} N, of tau +-${plainNumber(half.time, 3)} s`
      + (isExact ? ", K_0 taken as exact: it has no interval" : "")
    : "; K_ap or H has no interval, and so have K_1 and tau none";
  return `K_1 ${plainNumber(part.spring, 5)} N and tau ${plainNumber(part.time, 4)} s are identified from the surfaces `
    + "of K_ap and H and from K_0 at these levels: the exported line gives back K_ap "
    + `${plainNumber(part.apparent, 5)} N and H ${plainNumber(part.energyAt(part.frequency, amplitude), 4)} J/m there${known}`;
}

function saidPrinted(rest, printed, measured, frequency, amplitude) {
  if (!printed.length) return "the source has no surfaces of K_1 and tau that can be used";
  const [spring, time] = printed.map((one) => one.value);
  const said = `the printed surfaces of K_1 and tau, ${plainNumber(spring, 5)} N and ${plainNumber(time, 4)} s, are not used`;
  if (!(spring > 0 && time > 0)) return `${said}: they are not above zero`;
  const part = new Viscoelasticity(rest, spring, time, { frequency });
  return `${said}: they would give ${against(part, measured, amplitude)}`;
}

function saidInstead(part, measured, amplitude, reason) {
  return `DOUBTFUL: K_1 ${plainNumber(part.spring, 5)} N and tau ${plainNumber(part.time, 4)} s are those of the `
    + `printed surfaces; none give back K_ap and H there: ${DATA.reasons[reason]}. They give `
    + against(part, measured, amplitude);
}

function against(part, measured, amplitude) {
  const model = [part.apparent, part.energyAt(part.frequency, amplitude)];
  return [["K_ap", "N"], ["H", "J/m"]].map(([name, unit], place) => {
    const own = measured[place].value;
    const share = own > 0 ? `, ${fixed(100 * (model[place] / own - 1), 1, "+")} percent` : "";
    return `${name} ${plainNumber(model[place], 5)} ${unit} where the line has ${plainNumber(own, 5)}${share}`;
  }).join("; ");
}

function doubtsOfIdentified(found, half, energy) {
  const said = [];
  if (!Number.isFinite(energy.surface_low)) {
    said.push("DOUBTFUL: how well the damping is known is not known: H has no interval");
  } else if (energy.surface_low <= 0) {
    said.push("DOUBTFUL: the damping may be none: the 95 percent interval of H, "
      + `${intervalOf(energy)}, holds zero`);
  }
  if (half.time >= found.time) {
    said.push(`DOUBTFUL: the dashpot is hardly known: tau ${plainNumber(found.time, 4)} s with a 95 percent interval `
      + `of +-${plainNumber(half.time, 3)} s, from those of K_ap, H and K_0`);
  }
  return said;
}

function doubtsOfPrinted(time) {
  if (!Number.isFinite(time.surface_low)) {
    return ["DOUBTFUL: how well the dashpot is known is not known: tau has no interval"];
  }
  if (time.surface_low <= 0) {
    return ["DOUBTFUL: the dashpot may be none: the 95 percent interval of tau, "
      + `${intervalOf(time)}, holds zero`];
  }
  return [];
}

function intervalOf(found) {
  if (!Number.isFinite(found.surface_low)) return "an interval, which the source does not have";
  return `${plainNumber(found.surface_low, 4)} to ${plainNumber(found.surface_high, 4)} ${found.unit}`;
}

function saidOfValue(found) {
  const isKnown = Number.isFinite(found.surface_high);
  return `${found.source}: ${found.quantity} ${plainNumber(found.value, 6)} ${found.unit}, `
    + (isKnown ? `95 percent of the surface ${intervalOf(found)}` : "no interval known")
    + (isKnown && found.surface_low < 0 ? ": its lower end is below zero: not told from zero" : "")
    + (found.errata.length ? `, errata ${found.errata.join(", ")}` : "")
    + (found.inside ? "" : ", OUTSIDE what was tested") + (found.is_untested ? ", untested corner" : "");
}
