// Whether the numbers of a line hold together, as reduction.lines.line_consistency has it.

const AP = "apparent_spring_constant", LOST = "hysteresis_energy", REST = "quasi_static_spring_constant";

// K_1 and tau of a loop in closed form, or the number of the reason why there are none.
function solvedLine(apparent, energy, amplitude, rate, rest) {
  const none = (reason) => ({ spring: NaN, time: NaN, reason });
  const given = [apparent, energy, amplitude, rate];
  if (!given.every(Number.isFinite)) return none(3);
  if (!given.every((one) => one > 0)) return none(4);
  const lost = (energy * apparent ** 2) / (Math.PI * amplitude ** 2);
  if (!(lost < apparent)) return none(5);
  if (Number.isNaN(rest)) return none(1);
  if (!(rest > 0 && rest < Infinity)) return none(2);
  const excess = Math.sqrt((apparent - lost) * (apparent + lost)) - rest;
  if (!(excess > 0)) return none(6);
  const turn = excess / lost;
  return { spring: excess + lost / turn, time: turn / (2 * Math.PI * rate), reason: 0 };
}

const STEP = 1e-4;

// Half width of the 95 % interval of a weighted sum of numbers that share errors.
function halfOfDifference(parts) {
  const shared = new Map();
  for (const [weight, one] of parts) {
    one.component.forEach(([source, of, number, freedom], place) => {
      const key = JSON.stringify([source, of, number]);
      const [sum] = shared.get(key) ?? [0];
      shared.set(key, [sum + weight * one.contribution[place], freedom]);
    });
  }
  const rows = [...shared.values()];
  return halfWidthOfParts(parts.map(([weight, one]) => Math.abs(weight) * one.random),
    parts.map(([, one]) => one.freedom), rows.map((one) => one[0]), rows.map((one) => one[1]));
}

// Chord of a bent spring between ends of a mean tension, as stages.three_parameter_line.loop_midline has it.
function springOfCycle(constantAt, mean, half) {
  const end = (start, step) => {
    const first = constantAt(start), second = constantAt(start + (step / 2) * first);
    const third = constantAt(start + (step / 2) * second), last = constantAt(start + step * third);
    return start + (step / 6) * (first + 2 * second + 2 * third + last);
  };
  let middle = mean;
  for (let round = 0; round < 12; round += 1) {
    middle = mean - ((end(middle, half) + end(middle, -half)) / 2 - middle);
  }
  return (end(middle, half) - end(middle, -half)) / (2 * half);
}

// K_0 of a cycle over its slope at the mean tension, by the bend of the runs: reduction.lines.bent_loops.
function shareOfSlope(curve, at, apparent, energy) {
  if (!curve.loop_bend) return 1;
  const constantAt = (tension) => {
    const found = evaluateCurve(curve, tension);
    return found.inside ? found.value : NaN;
  };
  const load = at.tension_amplitude, sine = (energy * apparent) / (Math.PI * load ** 2);
  const ratio = springOfCycle(constantAt, at.mean_tension, (load / apparent) * Math.sqrt(1 - sine ** 2))
    / constantAt(at.mean_tension);
  return Number.isFinite(ratio) && ratio > 0 ? 1 + curve.loop_bend * (ratio - 1) : 1;
}

// Of each slow pull what the surfaces give at a point and what would hold together there.
function consistentValues(line, at) {
  if (!line.surfaces[AP] || !line.surfaces[LOST] || !("mean_tension" in at && "tension_amplitude" in at)) return [];
  const found = {}, printed = {};
  for (const name of [AP, LOST, SPRING, TIME].filter((one) => line.surfaces[one])) {
    const surface = line.surfaces[name];
    found[name] = { ...evaluateSurface(surface, line.factors.map((factor) => at[factor])), component: surface.component };
    printed[name] = found[name].value;
  }
  return Object.entries(line.slow_pulls).map(([of, curve]) => {
    const pull = { ...evaluateCurve(curve, at.mean_tension), component: curve.component };
    const share = shareOfSlope(curve, at, printed[AP], printed[LOST]);
    const rest = line.is_printed || pull.inside ? share * pull.value : NaN;
    pull.contribution = pull.contribution.map((one) => share * one);
    pull.random = Math.hypot(share * pull.random, curve.loop_bend_misfit * rest);
    const solve = ([apparent, energy, slow]) => (
      solvedLine(apparent, energy, at.tension_amplitude, at.frequency, slow));
    const inputs = [printed[AP], printed[LOST], rest], solved = solve(inputs);
    const slope = (key, place) => {
      const [up, down] = [STEP, -STEP].map((side) => (
        solve(inputs.map((one, other) => (other === place ? one * (1 + side) : one)))[key]));
      return (up - down) / (2 * STEP * inputs[place]);
    };
    const half = {};
    for (const [name, key] of [[SPRING, "spring"], [TIME, "time"]]) {
      if (line.is_printed || !found[name]) continue;
      half[name] = halfOfDifference([...[found[AP], found[LOST], pull].map((one, place) => [slope(key, place), one]),
        [-1, found[name]]]);
    }
    return {
      of, printed, rest, half, ...solved,
      isApart: Object.fromEntries(Object.entries({ [SPRING]: "spring", [TIME]: "time" }).map(([name, key]) => (
        [name, name in half && Math.abs(printed[name] - solved[key]) > half[name]]))),
      excess: printed[AP] - rest - (printed[SPRING] ?? NaN),
      uncertainty: Math.hypot(found[AP].random, found[SPRING]?.random ?? NaN),
    };
  });
}

// Of K_1 or tau of its own surface, that it is not what the other surfaces give.
function apartWarning(values, name) {
  if (!values.length || !values.every((one) => one.isApart[name])) return [];
  const [key, unit] = name === SPRING ? ["spring", "N"] : ["time", "s"];
  const solved = values.map((one) => `${plainNumber(one[key], 4)} ${unit} (${one.of}; the 95 % interval about it `
    + `is +-${plainNumber(one.half[name], 2)} ${unit})`).join(" or ");
  return [`the surfaces are inconsistent at 1 of 1 points: ${name} of its own surface is `
    + `${plainNumber(values[0].printed[name], 4)} ${unit}, and K_ap, H and K_0 give ${solved}`];
}

// What a person has to know before the number.
function warningsOf(line, found, at) {
  const told = [...line.warnings, ...found.warnings], columns = line.column_warnings, { quantity } = found;
  if (![AP, SPRING, TIME, DASHPOT].includes(quantity)) return distinct(told);
  if (!line.is_printed) {
    const values = consistentValues(line, at);
    const names = { [DASHPOT]: [SPRING, TIME], [TIME]: [TIME] }[quantity] ?? [SPRING];
    return distinct([...told, ...names.flatMap((name) => apartWarning(values, name))]);
  }
  const values = quantity === TIME ? [] : consistentValues(line, at);
  // by more than the 95 % half width; by any amount if that is unknown
  const isContradicted = values.length > 0 && values.every((one) => one.excess > 1.96 * (one.uncertainty || 0));
  if (isContradicted) {
    const force = (number) => `${plainNumber(number, 4)} N`;
    const lowerBy = (one) => {
      const z = one.excess / one.uncertainty;
      return Number.isFinite(z) ? `; ${z.toFixed(1)} standard errors lower` : "";
    };
    const sums = values.map((one) => `${force(one.rest + one.printed[SPRING])} (${one.of}${lowerBy(one)})`).join(" or ");
    told.push("the printed numbers are inconsistent at 1 of 1 points: K_ap cannot exceed K_0 + K_1, but is printed as "
      + `${force(values[0].printed[AP])} where K_0 + K_1 is ${sums}; K_ap and H need a K_1 of `
      + `${values.map((one) => force(one.spring)).join(" or ")}, printed is `
      + `${force(values[0].printed[SPRING])}`);
  }
  const asked = { [DASHPOT]: [SPRING, TIME], [SPRING]: [SPRING], [TIME]: [TIME] }[quantity] ?? (isContradicted ? [SPRING] : []);
  return distinct([...told, ...asked.flatMap((name) => columns[name] ?? [])]);
}

// Tables that the command shows behind the answer: every K_0; K_1 and tau that go with K_ap and H.
function moreTables(line, found, at, system) {
  const [force, scale] = displayUnit("N", system);
  const pulls = Object.entries(line.slow_pulls);
  if (found.quantity === REST && pulls.length > 1) {
    return [{
      intro: "", heads: [`mean tension\n[${force}]`, "K_0 from", `K_0\n[${force}]`, "greatest z\nof printed K_1"],
      rows: pulls.map(([of, curve]) => [
        asGiven(scale * at.mean_tension), of, short(scale * evaluateCurve(curve, at.mean_tension).value),
        short(numbersOf(line.greatest_z[of] ?? null), 3)]),
    }];
  }
  const values = [AP, LOST, SPRING, TIME, DASHPOT].includes(found.quantity) ? consistentValues(line, at) : [];
  if (!values.length) return [];
  const levels = levelCells(line, at, system);
  const stated = line.is_printed ? "printed" : "of surface";
  const remarkOf = (one) => {
    const apart = [["K_1", SPRING], ["tau", TIME]].filter(([, name]) => one.isApart[name]).map(([symbol]) => symbol);
    if (apart.length) return `${apart.join(" and ")}: outside the interval`;
    return DATA.reasons[one.reason] || (line.is_printed && one.excess > 0 ? "printed K_ap is above K_0 + printed K_1" : "-");
  };
  return [{
    intro: line.is_printed
      ? "K_1 and tau as printed, and solved from K_ap, H and K_0 by the three-parameter model:"
      : "K_1 and tau of their own surfaces, and solved from K_ap, H and K_0 by the three-parameter model:",
    heads: [...levels.map((one) => one[0]), "K_0 from", `K_ap\n[${force}]`, `K_0\n[${force}]`,
      `K_1 ${stated}\n[${force}]`, `K_1 solved\n[${force}]`, `tau ${stated}\n[s]`, "tau solved\n[s]", "remark"],
    rows: values.map((one) => [
      ...levels.map((cell) => cell[1]), one.of,
      ...[[one.printed[AP], scale], [one.rest, scale], [one.printed[SPRING] ?? NaN, scale], [one.spring, scale],
        [one.printed[TIME] ?? NaN, 1], [one.time, 1]].map(([number, by]) => short(by * number)),
      remarkOf(one)]),
  }];
}
