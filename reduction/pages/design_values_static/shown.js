// What a reader is shown of a look-up: the same texts as the command gives.

const TENSIONS = ["mean_tension", "tension_amplitude", "tension"];

function displayUnit(unit, system) {
  return DATA.shown[unit][system];
}

function unitOfLevel(name, system) {
  return name === "strain" ? ["%", 100] : displayUnit(unitOf(name), system);
}

function span(factor, low, high) {
  if (!(Number.isFinite(low) && Number.isFinite(high))) return "-";
  const half = (factor * (high - low)) / 2;
  return `${within(factor * low, half)} to ${within(factor * high, half)}`;
}

function remarksOf(found) {
  const isBelow = found.value < 0;
  return [
    ["OUTSIDE the tested range", !found.inside],
    ["untested corner", found.is_untested],
    ["peak above the residual strength", found.own_peak_share >= 1],
    ["peak above the rule", found.is_above_rule],
    ["snap load: goes slack", found.is_slack && found.peak > 0],
    ["negative: do not use", isBelow],
    ["interval includes zero", !isBelow && (found.low < 0 || found.surface_low < 0)],
  ].filter((one) => one[1]).map((one) => one[0]);
}

// The value as the row has it, to what its intervals leave.
function valueText(found, factor) {
  return within(factor * found.value, ...intervalsOf(found).map(([, low, high]) => (factor * (high - low)) / 2));
}

// Headings and cells of the levels that were asked for.
function levelCells(line, levels, system) {
  const row = [];
  for (const [name, value] of Object.entries(levels)) {
    const [unit, factor] = unitOfLevel(name, system);
    row.push([`${name.replaceAll("_", "\n")}\n[${unit}]`, asGiven(factor * value)]);
    if (TENSIONS.includes(name) && Number.isFinite(line.rated_break_strength)) {
      row.push(["\n[%RBS]", short((100 * value) / line.rated_break_strength, 4)]);
    }
  }
  return row;
}

// Headings and cells of one row, as the table of the command has them.
function rowOf(line, found, levels, system) {
  const row = levelCells(line, levels, system);
  const [unit, factor] = displayUnit(found.unit, system);
  row.push([`value\n[${unit}]`, valueText(found, factor)]);
  // rope makers and rules state stiffness relative to break strength
  if (found.unit === "N" && found.quantity !== "branch_tension" && !line.strength_of && Number.isFinite(line.rated_break_strength)) {
    row.push(["value\n[MBL]", short(found.value / line.rated_break_strength, 3)]);
  }
  row.push(...intervalsOf(found).map(([head, low, high]) => [head, span(factor, low, high)]));
  row.push(["peak\n[%RBS]", short(100 * found.peak_share, 4)]);
  row.push(["minimum\n[%RBS]", short(100 * found.minimum_share, 4)]);
  if (Number.isFinite(line.tensile_strength)) {
    row.push(["peak [% of\nresidual strength]", short(100 * found.own_peak_share, 4)]);
  }
  row.push(["remark", remarksOf(found).join("; ")]);
  return row;
}

function intervalsOf(found) {
  return [
    ["95 % interval,\none more run", found.low, found.high],
    [`95 % interval,\n${found.interval_of ? "the surface" : "this test"}`, found.surface_low, found.surface_high],
    ["95 % interval,\nanother specimen", found.line_low, found.line_high],
  ].filter((one) => Number.isFinite(one[1]));
}

// What is stated of the line, its rule, its errata and notes; each sentence once.
function saidOf(line, found) {
  const said = [];
  for (const [what, value] of [["in air", line.linear_density], ["in water", line.wet_linear_density]]) {
    if (Number.isFinite(value)) said.push(`linear density ${what}: ${short(value)} kg/m`);
  }
  const conditions = Object.entries(line.conditions).map(([name, text]) => `${name} ${text}`);
  if (conditions.length) said.push(`test conditions: ${conditions.join(", ")}`);
  said.push(`rule: ${found.rule}`);
  if (found.errata.length) said.push(`errata that apply: ${found.errata.join(", ")}`);
  said.push(...found.notes.map((note) => `note: ${note}`));
  return distinct(said);
}

function headlineOf(line, found) {
  const branch = found.branch ? `, ${found.branch} branch` : "";
  return `${found.quantity} of ${line.name}${branch}; ${found.source}`;
}

// Level in SI of a number and a unit; a share is one of the break strength.
function levelInSi(name, number, unit, strength) {
  if (unit === "%RBS") {
    if (!Number.isFinite(strength)) {
      throw new Refusal("a share of the break strength is given, but no break strength", {
        found: `'${number} %RBS'`, needed: "rated_break_strength of the specimen",
      });
    }
    return (number / 100) * strength;
  }
  return scaleOf(DATA.levels[name], unit) * number;
}

// Factor from a unit that may be given to SI.
function scaleOf(dimension, unit) {
  return DATA.given[dimension].find((one) => one[0] === unit)[1];
}

// The answer to a question as a whole, or the refusal of it.
function answer({ line, quantity, levels, branch = null, flag = false, system = "si" }) {
  const of = LINES.find((one) => one.key === line);
  const at = Object.fromEntries(Object.entries(levels).map(([name, [number, unit]]) => (
    [name, levelInSi(name, number, unit, of.rated_break_strength)])));
  try {
    const found = lookUp(of, quantity, at, { branch, flag });
    return {
      headline: headlineOf(of, found), row: rowOf(of, found, at, system), said: saidOf(of, found), found, at,
      warnings: warningsOf(of, found, at), tables: moreTables(of, found, at, system),
    };
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return { refused: error.message, refusal: error, at };
  }
}

// Levels at which the tests of a rope were made, as the list of the command has them; null where
// it is one test, or an experiment has fitted them.
function tableOfLevels(line, system) {
  const own = LINES.filter((one) => one.campaign && one.campaign === line.campaign
    && one.specimens.some((name) => line.specimens.includes(name)));
  const rows = own.flatMap((one) => one.levels.slice(0, 1).flatMap((levels) => levels.tests.map((test, place) => (
    { levels, test, at: levels.at[place], value: levels.value[place], conditions: levels.conditions[place] ?? {} }))));
  if (rows.length < 2 || own.some((one) => Object.keys(one.surfaces).length)) return null;
  const { quantity, variables } = rows[0].levels;
  const keys = distinct(rows.flatMap((one) => Object.keys(one.conditions)));
  const [unit, factor] = displayUnit(unitOf(quantity), system), strength = line.rated_break_strength;
  const cells = rows.map(({ test, at, value, conditions }) => {
    const levels = levelCells(line, Object.fromEntries(variables.map((name, place) => [name, at[place]])), system);
    return [["test", test], ...levels, [`${quantity.replaceAll("_", " ")}\n[${unit}]`, short(factor * value)],
      ["\n[MBL]", short(value / strength, 3)], ...keys.map((key) => [key, conditions[key] ?? "-"])];
  });
  return {
    intro: `Levels of ${line.specimens[0]}, known at tested levels and between two of them`,
    heads: cells[0].map(([head]) => head), rows: cells.map((row) => row.map(([, text]) => text)),
  };
}
