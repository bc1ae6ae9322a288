// A line as a deck of MoorDyn takes it: what is stated, its header, its row, its deck.

const HEADER_WIDTH = 100, SEGMENTS = 5, DECK_LENGTH = 10, DECK_DEPTH = 100;

function number15(value) {
  return general(value, 15);
}

// White space as Python splits text at it.
const BLANKS = /[\s\x1c-\x1f\x85]+/u;

// One line of ASCII without comment or rule signs.
function oneLine(text) {
  const ascii = Array.from(text.split(BLANKS).filter(Boolean).join(" "))
    .map((sign) => (sign.codePointAt(0) < 128 ? sign : "?")).join("");
  return ascii.replaceAll("%", " percent").replace(/[#!%*\\"|{}&]/g, " ").replace(/-{2,}/g, "-");
}

// As textwrap.wrap, with two blanks before every line but the first.
function wrapped(text) {
  const chunks = text.split(/([ \t\n\v\f\r]+)/).filter(Boolean), lines = [];
  while (chunks.length) {
    const indent = lines.length ? "  " : "", width = HEADER_WIDTH - indent.length, current = [];
    let size = 0;
    if (lines.length && !chunks[0].trim()) chunks.shift();
    while (chunks.length && size + chunks[0].length <= width) {
      size += chunks[0].length;
      current.push(chunks.shift());
    }
    if (chunks.length && chunks[0].length > width) {
      const left = width - size;
      current.push(chunks[0].slice(0, left));
      chunks[0] = chunks[0].slice(left);
    }
    if (current.length && !current[current.length - 1].trim()) current.pop();
    if (current.length) lines.push(indent + current.join(""));
  }
  return lines;
}

// The curve with what the user states of the line; refused where the two do not fit.
function statedLine(curve, stated) {
  const line = { ...curve, sources: [...curve.sources], notes: [...curve.notes] };
  for (const name of ["diameter", "linear_density", "wet_linear_density"]) {
    if (Number.isFinite(stated[name])) {
      line[name] = stated[name];
      line.sources.push(`${name.replaceAll("_", " ")}: stated at the export`);
    }
  }
  if (line.wet_linear_density >= line.linear_density) {
    throw new Refusal(`${line.name} is not lighter in water than in air`, {
      found: `${plainNumber(line.wet_linear_density, 6)} kg/m in water, ${plainNumber(line.linear_density, 6)} kg/m in air`,
      needed: "a wet linear density below the dry one",
    });
  }
  return line;
}

function needed(line, name) {
  if (Number.isFinite(line[name]) && line[name] > 0) return line[name];
  throw new Refusal(`the ${name.replaceAll("_", " ")} of ${line.name} is not known, and this format needs it`, {
    needed: `${name} above zero`, hint: `Give --${name.replaceAll("_", "-")} with a unit.`,
  });
}

// Diameter of the cylinder that displaces as much water, and how it was found.
function volumeDiameter(line) {
  const { water, fibres } = DATA.export;
  let displaced = (line.linear_density - line.wet_linear_density) / water;
  let words = `dry and wet mass in water of ${plainNumber(water, 6)} kg/m3`;
  const material = line.material.trim().toLowerCase();
  const density = Object.hasOwn(fibres, material) ? fibres[material] : NaN;
  if (!Number.isFinite(displaced)) {
    displaced = line.linear_density / density;
    words = `the mass a length and the density of ${line.material} fibre, ${plainNumber(density, 6)} kg/m3 `
      + "(Bigon and Regazzoni, The Morrow Guide to Knots, p. 14), since no wet mass is stated";
  }
  if (displaced > 0) {
    const diameter = Math.sqrt((4 * displaced) / Math.PI);
    const nominal = Number.isNaN(line.diameter) ? ""
      : `; drag refers to it, and not to the nominal ${plainNumber(1000 * line.diameter, 4)} mm`;
    return [diameter, `diameter: ${plainNumber(1000 * diameter, 4)} mm, of the displaced volume, from ${words}${nominal}`];
  }
  return [needed(line, "diameter"), "diameter: nominal; the displaced volume of a rope is smaller"];
}

function rangeOf(line) {
  const [low, high] = line.tested;
  if (Number.isNaN(low)) return "nothing was tested";
  const start = low > EDGE * high
    ? `; the start, a line from 0 0 up to strain ${plainNumber(low, 6)}, was NOT measured on this curve` : "";
  return `tested from strain ${plainNumber(low, 6)} to ${plainNumber(high, 6)}${start}`;
}

// What of a line is in doubt.
function doubtsOf(line) {
  const mass = line.linear_density, nominal = line.diameter;
  if (!(Number.isFinite(mass) && Number.isFinite(nominal))) return [];
  const volume = volumeDiameter(line)[0];
  const floats = ((DATA.export.water * Math.PI) / 4) * volume ** 2;
  const unfit = (than) => [`DOUBTFUL: the displaced volume has a diameter of ${plainNumber(1000 * volume, 4)} mm, `
    + `${than} the nominal one of ${plainNumber(1000 * nominal, 4)} mm: mass a length and diameter do not fit`];
  if (mass < floats && !Number.isFinite(line.wet_linear_density)) {
    return [`DOUBTFUL: the line floats: ${plainNumber(mass, 4)} kg/m displaces ${plainNumber(floats, 4)} kg/m of `
      + "water. Unless it does, state --wet-linear-density"];
  }
  if (volume > (1 + EDGE) * nominal) return unfit("above");
  return volume < 0.6 * nominal ? unfit("far below") : [];
}

function headerLines(line, curve, remarks) {
  const told = [`${line.name}, by reduction ${DATA.export.version}`];
  if (line.synthetic) told.push("SYNTHETIC: made from a formula, nothing was tested");
  if (curve) {
    const last = curve.strain.length - 1;
    told.push(
      `Curve: ${line.curve}`,
      `Holds as ${rangeOf(line)}. The curve ends at strain ${plainNumber(curve.strain[last], 6)} and `
        + `tension ${plainNumber(curve.tension[last], 6)} N; beyond it nothing is known; some codes keep the `
        + "last tension there",
      `${curve.strain.length} points of ${line.strain.length}; greatest error ${plainNumber(curve.error, 3)} N, `
        + `${scientific(curve.share, 2)} of the greatest tension; ${curve.local}`);
    if (curve.words) told.push(`At the start: ${curve.words}`);
  }
  told.push(...line.sources.map((text) => `Source: ${text}`), ...line.notes.map((text) => `Note: ${text}`),
    ...doubtsOf(line).map((text) => `Note: ${text}`), ...remarks.filter(Boolean).map((text) => `Remark: ${text}`));
  return told.flatMap((text) => wrapped(oneLine(text)));
}

function lineTypeRow(line, stiffness, damping) {
  const water = DATA.export.hydrodynamics;
  const diameter = volumeDiameter(line)[0], mass = needed(line, "linear_density");
  return [line.identifier, number15(diameter), number15(mass), stiffness, damping, "0",
    ...[water.normal_drag, water.normal_added_mass, water.axial_drag, water.axial_added_mass].map(number15)].join(" ");
}

function stepsOf(mass, stiffness, apart) {
  const step = 0.1 * apart * Math.sqrt(mass / stiffness);
  return step < 1e-4 ? [1, 0.02] : [SEGMENTS, Math.min(step, 0.02)];
}

// A whole input file: one line between two points, with a strain that it may have.
function deckOf(line, row, head, strain, stiffness) {
  const [segments, step] = stepsOf(needed(line, "linear_density"), stiffness, DECK_LENGTH / SEGMENTS);
  const depth = Math.max(DECK_DEPTH, 2 * DECK_LENGTH * (1 + strain)), top = DECK_LENGTH * (1 + strain) - depth;
  const rule = "-".repeat(22);
  return [
    "MoorDyn input file with one line type, in a deck that tries it",
    "NO GRAVITY in this deck (0 g), so that its tension is that of its strain: put 9.81, or take the line "
      + "type into a deck of your own",
    ...head,
    `${rule} LINE TYPES ${rule}`,
    "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
    "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
    row,
    `${rule} POINTS ${rule}`,
    "ID Attachment X Y Z Mass Volume CdA Ca",
    "(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)",
    `1 Fixed 0 0 ${number15(-depth)} 0 0 0 0`,
    `2 Coupled 0 0 ${number15(top)} 0 0 0 0`,
    `${rule} LINES ${rule}`,
    "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
    "(-) (name) (ID) (ID) (m) (-) (-)",
    `1 ${line.identifier} 1 2 ${number15(DECK_LENGTH)} ${segments} -`,
    `${rule} OPTIONS ${rule}`,
    "0 writeLog",
    "1 disableOutTime",
    "0 g",
    `${number15(2 * depth)} WtrDpth`,
    `${plainNumber(step, 3)} dtM`,
    "10 TmaxIC",
    "0.1 dtIC",
    `${rule} OUTPUTS ${rule}`,
    "FairTen1",
    "AnchTen1",
    `${rule} need this line ${rule}`,
    "",
  ].join("\n");
}
