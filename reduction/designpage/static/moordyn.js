// Files of a MoorDyn line type, as reduction export --to moordyn writes them.

// Deck and table, by name; refused where the command refuses.
function moordynFiles({ line: key, form, curve, levels = null, isShare = false, stated = {}, flag = false }) {
  const of = LINES.find((one) => one.key === key);
  const known = of.export[curve] ?? of.export[""];
  if ("refused" in known) throw new Refusal(known.refused);
  if (form === "table") {
    const line = statedLine(known, stated);
    line.notes.push(...(Number.isFinite(stated.rated_break_strength) ? [] : line.last_notes));
    return tableFiles({ ...line, notes: distinct(line.notes) });
  }
  if (of.campaign) {
    throw new Refusal("levels of a cycle choose nothing in an archive of one test", {
      found: Object.keys(levels ?? {}).map((name) => `--${name.replaceAll("_", "-")}`).join(", "),
      needed: "a published line",
    });
  }
  const dynamics = lineDynamics(of, levels, flag);
  const line = statedLine({ ...known, sources: [...known.sources, ...dynamics.sources] }, stated);
  if (isShare && of.rated_break_strength > 0) {
    line.sources.push(`levels in percent of the break strength: of ${plainNumber(of.rated_break_strength, 6)} N, `
      + "that of the source");
  }
  line.notes = distinct([...line.notes, ...dynamics.notes, ...line.last_notes]).filter(Boolean);
  return stiffnessFiles(line, dynamics.part, form);
}

function saidOfType(line) {
  return [volumeDiameter(line)[1], `hydrodynamic coefficients: ${DATA.export.hydrodynamics.source}`,
    "bending stiffness 0: not measured"];
}

function tableFiles(line) {
  const curve = thinCurve(line.strain, line.tension), table = `${line.file}_table.txt`, damping = DATA.export.numerical_damping;
  const head = headerLines(line, curve, [
    ...saidOfType(line),
    `internal damping ${plainNumber(damping, 6)}: MoorDyn takes a number below zero for minus a `
      + "share of critical damping, and finds the damping of each segment by it; numerical, not measured",
    `${table} belongs beside this file`,
  ]);
  const row = lineTypeRow(line, table, number15(damping));
  const steepest = Math.max(...curve.strain.slice(1).map((strain, place) => (
    (curve.tension[place + 1] - curve.tension[place]) / (strain - curve.strain[place]))));
  const [low, high] = line.tested;
  const where = Number.isNaN(low) ? "nothing tested" : `tested ${plainNumber(low, 4)} to ${plainNumber(high, 4)}`;
  const first = oneLine(`${line.name}; ${line.synthetic ? "SYNTHETIC; " : ""}${line.curve}; error `
    + `${plainNumber(curve.error, 3)} N; ${where}; ${line.sources.join("; ")}`);
  const rows = curve.strain.map((strain, place) => `${number15(strain)} ${number15(curve.tension[place])}`);
  return [
    [`${line.file}.dat`, deckOf(line, row, head, line.strain[line.strain.length - 1] / 2, steepest)],
    [table, [first, "Strain Tension", "(-) (N)", ...rows].join("\n")],
  ];
}

function stiffnessFiles(line, part, form) {
  const apart = DECK_LENGTH / SEGMENTS;
  const fast = 0.1 * apart * Math.sqrt(part.fast * needed(line, "linear_density"));
  const damping = `${number15(part.slowDashpot)}|${number15(fast)}`;
  let stiffness = `${number15(part.rest)}|${number15(part.fast)}`;
  if (form === "load-dependent") {
    if (!(part.slope > 0)) {
      throw new Refusal(`no growth of the dynamic stiffness of ${line.name} with the mean tension can be written`, {
        found: part.growth || `slope ${plainNumber(part.slope, 6)}`,
        needed: "a slope above zero, and a stiffness above zero at no tension",
        hint: "Use --form static-dynamic.",
      });
    }
    stiffness = [part.rest, part.alpha, part.slope].map(number15).join("|");
  }
  const head = headerLines(line, null, [
    ...saidOfType(line),
    `EA_s ${plainNumber(part.rest, 6)} N is K_0; EA_d ${plainNumber(part.fast, 6)} N is K_0 + K_1; relaxation time `
      + `${plainNumber(part.time, 4)} s`,
    `the dashpot beside the slow spring is ${plainNumber(part.slowDashpot, 6)} N s, which behaves as `
      + `N = K_1 tau = ${plainNumber(part.dashpot, 6)} N s of the Maxwell form`,
    part.holds ? `found at ${part.holds}` : "",
    "a spring constant holds about a mean; the strain of the deck starts at zero tension",
    form === "static-dynamic" ? "" : "MoorDyn takes the running tension of the slow part for "
      + "the mean: about it K_ap of a cycle is 2 to 4 percent above that of static-dynamic on the published lines",
    `BA_d ${plainNumber(fast, 4)} N s: 0.1 of critical for segments of ${plainNumber(apart, 6)} m, numerical, not `
      + "measured; without it the integration grows",
  ]);
  const row = lineTypeRow(line, stiffness, damping);
  return [[`${line.file}.dat`, deckOf(line, row, head, line.strain[line.strain.length - 1] / 2, part.fast)]];
}
