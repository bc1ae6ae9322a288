// Whether the printed numbers of a line hold together, as reduction.lines.line_consistency has it.

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

// Of each slow pull what is printed at a point and what would hold together there.
function consistentValues(line, at) {
  if (!line.surfaces[AP] || !line.surfaces[LOST]) return [];
  const printed = {}, spread = {};
  for (const name of [AP, LOST, SPRING, TIME].filter((one) => line.surfaces[one])) {
    const found = evaluateSurface(line.surfaces[name], line.factors.map((factor) => at[factor]));
    [printed[name], spread[name]] = [found.value, found.random];
  }
  return Object.entries(line.slow_pulls).map(([of, curve]) => {
    const rest = evaluateCurve(curve, at.mean_tension).value;
    return {
      of, printed, rest,
      ...solvedLine(printed[AP], printed[LOST], at.tension_amplitude, at.frequency, rest),
      excess: printed[AP] - rest - (printed[SPRING] ?? NaN),
      uncertainty: Math.hypot(spread[AP], spread[SPRING] ?? NaN),
    };
  });
}

// What a person has to know before the number.
function warningsOf(line, found, at) {
  const told = [...found.warnings], columns = line.column_warnings, { quantity } = found;
  if (![AP, SPRING, TIME, DASHPOT].includes(quantity)) return told;
  const values = quantity === TIME ? [] : consistentValues(line, at);
  const isImpossible = values.length > 0 && values.every((one) => one.excess > 0);
  if (isImpossible) {
    const force = (number) => `${plainNumber(number, 4)} N`;
    const sums = values.map((one) => `${force(one.rest + one.printed[SPRING])} (${one.of}; `
      + `z ${(one.excess / one.uncertainty).toFixed(1)})`).join(" or ");
    told.push("the printed numbers cannot hold together at 1 of 1 points: K_ap of a line is at most "
      + `K_0 + K_1, and is ${force(values[0].printed[AP])} where K_0 + K_1 is ${sums}; K_ap and H `
      + `need a K_1 of ${values.map((one) => force(one.spring)).join(" or ")}, printed is `
      + `${force(values[0].printed[SPRING])}`);
  }
  const asked = { [DASHPOT]: [SPRING, TIME], [SPRING]: [SPRING], [TIME]: [TIME] }[quantity] ?? (isImpossible ? [SPRING] : []);
  return distinct([...told, ...asked.flatMap((name) => columns[name] ?? [])]);
}

// Tables that the command shows behind the answer: every K_0; K_1 and tau that go with K_ap and H.
function moreTables(line, found, at, system) {
  const [force, scale] = displayUnit("N", system);
  const pulls = Object.entries(line.slow_pulls);
  if (found.quantity === REST && pulls.length > 1) {
    return [{
      intro: "", heads: [`mean tension\n[${force}]`, "K_0 by", `K_0\n[${force}]`, "greatest z\nof printed K_1"],
      rows: pulls.map(([of, curve]) => [
        asGiven(scale * at.mean_tension), of, short(scale * evaluateCurve(curve, at.mean_tension).value),
        short(numbersOf(line.greatest_z[of] ?? null), 3)]),
    }];
  }
  const values = [AP, LOST, SPRING, TIME, DASHPOT].includes(found.quantity) ? consistentValues(line, at) : [];
  if (!values.length) return [];
  const levels = levelCells(line, at, system);
  return [{
    intro: "as printed, and with the K_1 and tau that K_ap, H and K_0 give by the line model:",
    heads: [...levels.map((one) => one[0]), "K_0 by", `K_ap\n[${force}]`, `K_0\n[${force}]`,
      `K_1 printed\n[${force}]`, `K_1 solved\n[${force}]`, "tau printed\n[s]", "tau solved\n[s]", "remark"],
    rows: values.map((one) => [
      ...levels.map((cell) => cell[1]), one.of,
      ...[[one.printed[AP], scale], [one.rest, scale], [one.printed[SPRING] ?? NaN, scale], [one.spring, scale],
        [one.printed[TIME] ?? NaN, 1], [one.time, 1]].map(([number, by]) => short(by * number)),
      DATA.reasons[one.reason] || (one.excess > 0 ? "printed K_ap is above K_0 + printed K_1" : "-")]),
  }];
}
