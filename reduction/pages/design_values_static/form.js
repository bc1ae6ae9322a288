// The form: which line, which quantity, at which levels.

const byId = (id) => document.getElementById(id);
const FILTERS = [
  ["group", "Where from", (line) => line.group],
  ["material", "Material", (line) => line.material],
  ["construction", "Construction", (line) => line.construction],
  ["condition", "Condition", (line) => line.condition],
  ["diameter", "Diameter", (line) => diameterOf(line)],
];
// what the user has typed, by the name of a level; the rest follows the line
const STATE = { levels: {} };

function element(name, text = null, attributes = {}) {
  const made = document.createElement(name);
  if (text !== null) made.textContent = text;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

function system() {
  return document.querySelector("input[name=units]:checked").value;
}

function diameterOf(line) {
  if (!Number.isFinite(line.diameter)) return "";
  return system() === "us" ? `${short(line.diameter / 0.0254, 4)} in` : `${short(1000 * line.diameter, 4)} mm`;
}

function fill(select, options, chosen) {
  const before = chosen ?? select.value;
  select.replaceChildren(...options.map(([value, text]) => element("option", text, { value })));
  const has = options.some((one) => one[0] === before);
  select.value = has ? before : options[0]?.[0] ?? "";
}

function makeFilters() {
  for (const [name, title] of FILTERS) {
    const box = element("div");
    box.append(element("label", title, { for: `filter-${name}` }), element("select", null, { id: `filter-${name}` }));
    byId("filters").append(box);
  }
}

function fillFilters() {
  for (const [name, , of] of FILTERS) {
    const values = distinct(LINES.map(of)).filter(Boolean);
    if (name === "diameter") values.sort((a, b) => parseFloat(a) - parseFloat(b));
    fill(byId(`filter-${name}`), [["", "any"], ...values.map((one) => [one, one])]);
  }
}

// Words in any order, by their beginning; a number as a whole, as the search of the command.
function hasWords(text, wanted) {
  const words = (one) => one.toLowerCase().match(/[\p{L}\p{N}]+/gu) ?? [];
  const there = words(text);
  return words(wanted).every((word) => there.some((one) => one === word
    || (/^\p{L}+$/u.test(word) && one.startsWith(word))));
}

function chosenLines() {
  return LINES.filter((line) => hasWords(
    [line.name, line.group, line.material, line.construction, line.condition, diameterOf(line)].join(" "),
    byId("find").value)
    && FILTERS.every(([name, , of]) => !byId(`filter-${name}`).value || of(line) === byId(`filter-${name}`).value));
}

function fillLines(chosen) {
  const found = chosenLines(), select = byId("line"), before = chosen ?? select.value;
  byId("count").textContent = `${found.length} of ${LINES.length}`;
  select.replaceChildren(...distinct(found.map((line) => line.group)).map((group) => {
    const box = element("optgroup", null, { label: group });
    box.append(...found.filter((line) => line.group === group).map((line) => (
      element("option", line.name + (line.is_synthetic ? " (synthetic)" : ""), { value: line.key }))));
    return box;
  }));
  const has = found.some((line) => line.key === before);
  select.value = has ? before : found[0]?.key ?? "";
}

function chosenLine() {
  return LINES.find((line) => line.key === byId("line").value) ?? null;
}

function titleOf(quantity) {
  const symbol = DATA.symbols[quantity], words = quantity.replaceAll("_", " ");
  return symbol ? `${symbol}, ${words}` : words;
}

function fillQuantities(chosen) {
  const line = chosenLine();
  // what is known at tested levels alone stands in their table
  const found = line ? line.quantities.filter((one) => one === DASHPOT || one in line.surfaces
    || line.curves.some((curve) => curve.quantity === one)) : [];
  fill(byId("quantity"), found.map((one) => [one, titleOf(one)]), chosen);
}

function fillBranches(chosen) {
  const line = chosenLine(), quantity = byId("quantity").value;
  const found = line ? line.curves.filter((one) => one.quantity === quantity && one.branch).map((one) => one.branch) : [];
  byId("branch-row").hidden = !found.length;
  fill(byId("branch"), found.map((one) => [one, one]), chosen);
}

function levelNames(line, quantity) {
  if (quantity === DASHPOT || quantity in line.surfaces) return line.factors;
  return line.curves.filter((one) => one.quantity === quantity).map((one) => one.variable).slice(0, 1);
}

function unitsOfLevel(line, name) {
  const units = DATA.given[DATA.levels[name]].map((one) => one[0]);
  const force = system() === "us" ? ["lbf"] : ["N", "kN"];
  if (DATA.levels[name] !== "force") return units;
  return [...(Number.isFinite(line.rated_break_strength) ? ["%RBS"] : []), ...force];
}

function inUnit(line, name, value, unit) {
  return value / levelInSi(name, 1, unit, line.rated_break_strength);
}

// Fields of the levels; what was typed stays where the line has it within the tested range.
function makeLevels() {
  const line = chosenLine(), box = byId("levels");
  box.replaceChildren();
  if (!line) return;
  const quantity = byId("quantity").value, branch = byId("branch").value;
  for (const name of levelNames(line, quantity)) {
    const [low, high] = rangeOfLevel(line, quantity, name, branch);
    const units = unitsOfLevel(line, name);
    const before = typedIn(units, name);
    const unit = before && units.includes(before[1]) ? before[1] : units[0];
    const isKept = before && before[2] && units.includes(before[1]);
    const number = isKept ? before[0] : short(inUnit(line, name, (low + high) / 2, unit), 4);
    STATE.levels[name] = [number, unit, isKept];
    const row = element("div", null, { class: "level" });
    const input = element("input", null, {
      id: `level-${name}`, type: "text", inputmode: "decimal", "aria-describedby": `tested-${name}`, spellcheck: "false",
    });
    input.value = number;
    const words = name.replaceAll("_", " ");
    const select = element("select", null, { id: `unit-${name}`, "aria-label": `unit of ${words}` });
    fill(select, units.map((one) => [one, one === "1" ? "number" : one]), unit);
    row.append(element("label", words[0].toUpperCase() + words.slice(1), { for: input.id }), input, select,
      element("span", testedText(line, name, low, high, unit), { id: `tested-${name}`, class: "small" }));
    input.addEventListener("input", () => {
      STATE.levels[name] = [input.value.trim(), select.value, true];
      show();
    });
    select.addEventListener("change", () => {
      const old = STATE.levels[name], value = Number(old[0]);
      const si = levelInSi(name, value, old[1], line.rated_break_strength);
      const text = old[0] !== "" && Number.isFinite(si) ? plainNumber(inUnit(line, name, si, select.value), 6) : old[0];
      STATE.levels[name] = [text, select.value, old[2]];
      input.value = text;
      byId(`tested-${name}`).textContent = testedText(line, name, low, high, select.value);
      show();
    });
    box.append(row);
  }
}

// What was typed for a level; a force in a unit that is not shown now is written in one that is.
function typedIn(units, name) {
  const before = STATE.levels[name];
  if (!before || !before[2] || units.includes(before[1]) || before[1] === "%RBS") return before;
  const unit = units.find((one) => one !== "%RBS");
  const number = (Number(before[0]) * scaleOf(DATA.levels[name], before[1])) / scaleOf(DATA.levels[name], unit);
  return [before[0] !== "" && Number.isFinite(number) ? plainNumber(number, 6) : before[0], unit, true];
}

function testedText(line, name, low, high, unit) {
  const [a, b] = [low, high].map((end) => short(inUnit(line, name, end, unit), 4));
  return `tested ${a} to ${b}${unit === "1" ? "" : ` ${unit}`}`;
}

function query() {
  const line = chosenLine();
  if (!line) return null;
  const quantity = byId("quantity").value;
  const names = levelNames(line, quantity);
  const bad = names.find((name) => STATE.levels[name][0] === "" || !Number.isFinite(Number(STATE.levels[name][0])));
  return {
    line: line.key, quantity, bad, flag: byId("flag").checked, system: system(),
    branch: byId("branch-row").hidden ? null : byId("branch").value,
    levels: Object.fromEntries(names.map((name) => [name, [Number(STATE.levels[name][0]), STATE.levels[name][1]]])),
  };
}
