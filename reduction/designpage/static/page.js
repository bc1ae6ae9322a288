// The form, the answer, and the link that holds both.

const DATA = JSON.parse(document.getElementById("data").textContent);

// Fields of a line whose numbers may be none or infinite.
function lineOf(line, key, group) {
  const numbers = ["diameter", "rated_break_strength", "tensile_strength", "linear_density", "wet_linear_density"];
  const decoded = (one, texts) => Object.fromEntries(Object.entries(one)
    .map(([name, value]) => [name, texts.includes(name) ? value : numbersOf(value)]));
  const ofSurface = ["quantity", "errata", "notes"];
  const ofCurve = ["quantity", "variable", "branch", "spread_of", "range_note", "errata", "notes", "is_inverse_slope"];
  const components = (one) => ({
    ...one, component: one.component.map(([source, of, number, freedom]) => [source, of, number, numbersOf(freedom)]),
  });
  return {
    ...line, key, group,
    ...Object.fromEntries(numbers.map((name) => [name, numbersOf(line[name])])),
    surfaces: Object.fromEntries(Object.entries(line.surfaces).map(([name, one]) => (
      [name, components({ ...decoded(one, [...ofSurface, "component"]), component: one.component })]))),
    curves: line.curves.map((one) => components({ ...decoded(one, [...ofCurve, "component"]), component: one.component })),
    export: Object.fromEntries(Object.entries(line.export).map(([name, one]) => [name, "refused" in one ? one : {
      ...one,
      ...Object.fromEntries(["tested", "diameter", "linear_density", "wet_linear_density"]
        .map((field) => [field, numbersOf(one[field])])),
    }])),
    is_synthetic: line.notes.includes("synthetic data"),
  };
}

const LINES = [
  ...DATA.published.map((line) => lineOf(line, line.name, "published")),
  ...DATA.campaigns.flatMap((campaign) => {
    const raw = Object.entries(campaign.files).flatMap(([test, one]) => one.lines.map((line) => [test, line]));
    return raw.map(([test, line], place) => lineOf(
      { ...line, name: campaign.names[place], specimen: line.name, test, campaign: campaign.name },
      `${campaign.name}/${campaign.names[place]}`, campaign.name));
  }),
];

const byId = (id) => document.getElementById(id);
const FILTERS = [
  ["group", "Where from", (line) => line.group],
  ["material", "Material", (line) => line.material],
  ["construction", "Construction", (line) => line.construction],
  ["condition", "Condition", (line) => line.condition],
  ["diameter", "Diameter", (line) => diameterOf(line)],
];
// what the user has typed, by the name of a level; the rest follows the line
const STATE = { levels: {}, stated: {} };

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
  fill(byId("quantity"), line ? line.quantities.map((one) => [one, titleOf(one)]) : [], chosen);
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

// Fields of the levels; what was typed stays where the line has it inside what was tested.
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
      const text = old[0] !== "" && Number.isFinite(si) ? general(inUnit(line, name, si, select.value), 6) : old[0];
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
  return [before[0] !== "" && Number.isFinite(number) ? general(number, 6) : before[0], unit, true];
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

function listOf(texts, name = "ul") {
  const list = element(name);
  list.append(...texts.map((text) => element("li", text)));
  return list;
}

// The cells of a row, each under the heading that the command gives it.
function showRow(row) {
  const box = element("div", null, { class: "row-of-values" }), intervals = element("dl", null, { class: "intervals" });
  const at = element("dl", null, { class: "at" });
  let last = null;
  for (const [head, text] of row) {
    const cell = element(head.startsWith("value") ? "strong" : "span", text, { "data-head": head });
    const words = head.replaceAll("\n", " ").trim(), [, name, unit] = words.match(/^(.*?) ?(?:\[(.*)\])?$/);
    if (head.startsWith("value")) {
      const value = element("p", null, { class: "value" });
      value.append(cell, ` ${unit === "1" ? "" : unit}`);
      box.append(value);
      box.dataset.unit = unit;
    } else if (head.startsWith("95")) {
      intervals.append(element("dt", words), element("dd"));
      intervals.lastChild.append(cell, ` ${box.dataset.unit === "1" ? "" : box.dataset.unit}`);
    } else if (head !== "remark" && !name) {
      last.append(", ", cell, " %RBS");
    } else if (head !== "remark") {
      last = element("dd");
      last.append(cell, ` ${unit === "% of what it still has" ? "% of the strength it still has" : unit}`);
      at.append(element("dt", name), last);
    }
  }
  if (intervals.childElementCount) box.append(intervals);
  else box.append(element("p", "no interval: the notes say why", { class: "small" }));
  box.append(at);
  return box;
}

function showRefusal(said, asked) {
  const { refusal } = asked;
  const box = element("div", null, { class: "refused" });
  const hint = (refusal.hint ?? "").replace(FLAG_HINT, "").replace(/\. $/, ".").trim();
  const texts = [refusal.found && `found ${refusal.found}`, refusal.needed && `needed ${refusal.needed}`, hint].filter(Boolean);
  box.append(element("p", "Refused", { class: "refused-title" }), element("p", refusal.problem), listOf(texts));
  if ((refusal.hint ?? "").includes(FLAG_HINT)) {
    box.append(element("p", "“Outside what was tested too, flagged” gives the number and flags it.", { class: "small" }));
  }
  said.append(box);
}

// The answer in a line, for a screen on which it lies below the form.
function brief(text) {
  byId("brief").textContent = text;
}

function show() {
  const asked = query(), said = byId("said"), line = chosenLine();
  said.replaceChildren();
  byId("charts").replaceChildren();
  byId("notes").replaceChildren();
  byId("synthetic").hidden = !line?.is_synthetic;
  if (!asked || !asked.quantity) {
    byId("answer-title").textContent = line ? line.name : "No line is so";
    said.append(element("p", line ? "Nothing of this line can be looked up." : "No line has all of these: take a filter or a word away."));
    if (line) showAbsent(line);
    byId("type").hidden = true;
    brief("");
    return;
  }
  byId("type").hidden = false;
  byId("answer-title").textContent = `${titleOf(asked.quantity)}: ${line.name}`;
  keepLink(asked);
  byId("command").textContent = commandOf(line, asked);
  if (asked.bad) {
    said.append(element("p", `${asked.bad.replaceAll("_", " ")} is no number`, { class: "refused-title" }));
    brief("Not a number");
    return;
  }
  const found = answer(asked);
  if (found.refusal) {
    showRefusal(said, found);
    brief("Refused: why");
  } else {
    const remarks = remarksOf(found.found), [unit, factor] = displayUnit(found.found.unit, asked.system);
    brief(`${symbolOf(asked.quantity)} ${short(factor * found.found.value)} ${unit === "1" ? "" : unit}${remarks.length ? " (flagged)" : ""}`);
    if (remarks.length) {
      const flags = listOf(remarks);
      flags.className = "flags";
      said.append(flags);
    }
    said.append(showRow(found.row));
  }
  showCharts(line, asked, found);
  showNotes(line, asked, found);
  showType(line, asked, found);
}

function showCharts(line, asked, found) {
  const unit = displayUnit(unitOf(asked.quantity), asked.system);
  for (const [name, [, shown]] of Object.entries(asked.levels)) {
    const factor = 1 / levelInSi(name, 1, shown, line.rated_break_strength);
    const chart = chartOf({
      line, quantity: asked.quantity, branch: asked.branch, levels: found.at, name, found: found.found,
      x: [shown, factor], y: unit,
    });
    if (!chart) continue;
    const box = element("figure");
    box.append(chart);
    byId("charts").append(box);
  }
  if (byId("charts").childElementCount) {
    const bands = byId("charts").querySelector(".band")
      ? "Light band: 95 % of one more run; dark band: 95 % of the surface, or of the one test. " : "";
    const others = Object.keys(asked.levels).length > 1 ? " The other levels stay as chosen." : "";
    byId("charts").append(element("p", `${bands}Grey: not tested.${others}`, { class: "small legend" }));
  }
}

function showAbsent(line) {
  const missing = Object.entries(line.absent).filter(([name]) => !line.quantities.includes(name));
  if (!missing.length) return;
  byId("notes").append(element("h3", "What this line has not"),
    listOf(missing.map(([name, why]) => `${name.replaceAll("_", " ")}: ${why}`)));
}

function showNotes(line, asked, found) {
  const notes = byId("notes"), facts = element("dl", null, { class: "facts" });
  const fact = (name, text) => text && facts.append(element("dt", name), element("dd", text));
  const [force, scale] = displayUnit("N", asked.system);
  const printed = asked.quantity === DASHPOT ? [SPRING, TIME] : [asked.quantity];
  fact("source", line.printed
    ? distinct(printed.map((name) => line.printed[name] ?? line.source)).join("; ") : line.source);
  fact("campaign", line.campaign);
  fact("material", line.material);
  fact("construction", line.construction);
  fact("condition", line.condition);
  fact("diameter", diameterOf(line));
  if (Number.isFinite(line.rated_break_strength)) {
    fact("%RBS is of", `${short(scale * line.rated_break_strength)} ${force}${line.strength_of ? ` (${line.strength_of})` : ""}`);
  }
  if (Number.isFinite(line.tensile_strength)) fact("strength it still has", `${short(scale * line.tensile_strength)} ${force}`);
  notes.append(element("h3", "Source"), facts);
  if (found.found) {
    notes.append(element("h3", "Notes"), listOf(found.said.map((one) => one.replace(/^note: /, ""))));
    const errata = found.found.errata.filter((one) => one in DATA.errata);
    if (errata.length) {
      notes.append(element("h3", "Errata"));
      const list = element("dl", null, { class: "facts errata" });
      for (const one of errata) {
        const [place, print, evidence] = DATA.errata[one];
        const text = element("dd");
        text.append(element("span", `${place}: ${print}`), element("br"), element("span", evidence, { class: "small" }));
        list.append(element("dt", one), text);
      }
      notes.append(list);
    }
  }
  showAbsent(line);
}

function quoted(text) {
  return /^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

function commandOf(line, asked) {
  const parts = line.campaign
    ? [quoted(`processed/${line.campaign}`), "--line", quoted(line.name)] : [quoted(line.name)];
  for (const [name, [number, unit]] of Object.entries(asked.levels)) {
    parts.push(`--${name.replaceAll("_", "-")} "${unit === "1" ? number : `${number} ${unit}`}"`);
  }
  if (asked.branch) parts.push("--branch", asked.branch);
  if (asked.flag) parts.push("--extrapolate", "flag");
  if (asked.system === "us") parts.push("--units", "us");
  return `reduction lookup ${parts[0]} --quantity ${asked.quantity} ${parts.slice(1).join(" ")}`;
}

// The export that writes the files of a line type.
function exportCommandOf(line, asked, { form, curve, file }) {
  const parts = [line.campaign ? quoted(`processed/${line.campaign}/${line.test}.nc`) : quoted(line.name), "--to moordyn"];
  if (line.campaign) parts.push("--specimen", quoted(line.specimen), "--curve", curve);
  if (form !== "table") {
    parts.push("--form", form, ...Object.entries(asked.levels)
      .map(([name, given]) => `--${name.replaceAll("_", "-")} "${given.join(" ")}"`));
    if (asked.flag) parts.push("--extrapolate flag");
  }
  for (const [name] of STATED) {
    const [text, unit] = STATE.stated[name] ?? ["", ""];
    if (text !== "") parts.push(`--${name.replaceAll("_", "-")} "${text} ${unit}"`);
  }
  return `reduction export ${parts.join(" ")} --out ${file}`;
}

async function copy(text, what) {
  let isDone = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // a page from disk may not be let to the clipboard that way
    const area = element("textarea");
    area.value = text;
    document.body.append(area);
    area.select();
    isDone = document.execCommand("copy");
    area.remove();
  }
  byId("copied").textContent = isDone ? `${what} copied` : `${what} could not be copied: select it by hand`;
}

const STATED = [
  ["linear_density", "Linear density in air", ["kg/m", "g/m"], ["lb/ft"], "linear_density"],
  ["wet_linear_density", "In water", ["kg/m", "g/m"], ["lb/ft"], "linear_density"],
  ["diameter", "Diameter", ["mm"], ["in"], "length"],
];

function showType(line, asked, found) {
  const form = byId("type-form"), forms = line.campaign ? ["table"] : ["table", "static-dynamic", "load-dependent"];
  const curves = Object.keys(line.export);
  const chosen = STATE.form && forms.includes(STATE.form) ? STATE.form : "table";
  const curve = STATE.curve && curves.includes(STATE.curve) ? STATE.curve : curves[0];
  const isMade = form.dataset.of === `${line.key} ${asked.system}`;
  if (!isMade) {
    form.dataset.of = `${line.key} ${asked.system}`;
    form.replaceChildren();
    const choice = (id, title, options, value) => {
      const box = element("div"), select = element("select", null, { id });
      box.append(element("label", title, { for: id }), select);
      fill(select, options.map((one) => [one, one]), value);
      form.append(box);
      select.addEventListener("change", () => {
        STATE[id.replace("type-", "")] = select.value;
        show();
      });
    };
    choice("type-form-of", "Form", forms, chosen);
    form.querySelector("#type-form-of").addEventListener("change", (event) => {
      STATE.form = event.target.value;
      show();
    });
    if (curves.length > 1) choice("type-curve", "Curve", curves, curve);
    for (const [name, title, si, us] of STATED) {
      const units = asked.system === "us" ? us : si;
      const box = element("div"), input = element("input", null, { id: `stated-${name}`, type: "text", inputmode: "decimal" });
      const before = STATE.stated[name];
      const unit = before && units.includes(before[1]) ? before[1] : units[0];
      input.value = before && units.includes(before[1]) ? before[0] : "";
      STATE.stated[name] = [input.value, unit];
      const select = element("select", null, { "aria-label": `unit of ${title.toLowerCase()}` });
      fill(select, units.map((one) => [one, one]), unit);
      box.append(element("label", title, { for: input.id }), input, select);
      const typed = () => {
        STATE.stated[name] = [input.value.trim(), select.value];
        show();
      };
      input.addEventListener("input", typed);
      select.addEventListener("change", typed);
      form.append(box);
    }
  }
  showTypeText(line, asked, found, chosen, curve);
}

function showTypeText(line, asked, found, form, curve) {
  const box = byId("type-text"), stated = {};
  box.replaceChildren();
  for (const [name, , , , dimension] of STATED) {
    const [text, unit] = STATE.stated[name] ?? ["", ""];
    if (text === "") continue;
    if (!Number.isFinite(Number(text))) {
      box.append(element("p", `${name.replaceAll("_", " ")} is no number`, { class: "refused-title" }));
      return;
    }
    stated[name] = scaleOf(dimension, unit) * Number(text);
  }
  try {
    const isAt = form !== "table" && "mean_tension" in found.at && "tension_amplitude" in found.at;
    if (form !== "table" && !isAt) {
      box.append(element("p", "Static and dynamic stiffness are taken at a frequency, a mean tension and an amplitude: "
        + "choose a quantity of cycles above.", { class: "refused" }));
      return;
    }
    const files = moordynFiles({
      line: line.key, form, curve, stated, flag: asked.flag, levels: isAt ? found.at : null,
      isShare: Object.values(asked.levels).some((one) => one[1].includes("%RBS")),
    });
    for (const [name, text] of files) {
      const row = element("p", null, { class: "row" });
      const button = element("button", `Copy ${name}`, { type: "button" });
      button.addEventListener("click", () => copy(text, name));
      row.append(button);
      box.append(row, element("pre", text, { tabindex: "0", "aria-label": name }));
    }
    box.append(element("p", "The same files from the command line:", { class: "small" }),
      element("pre", exportCommandOf(line, asked, { form, curve, file: files[0][0] }), { tabindex: "0" }));
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    box.append(element("p", error.message, { class: "refused" }));
  }
}

function keepLink(asked) {
  const parts = new URLSearchParams({ line: asked.line, quantity: asked.quantity });
  if (asked.branch) parts.set("branch", asked.branch);
  for (const [name, [number, unit]] of Object.entries(STATE.levels)) {
    if (name in asked.levels) parts.set(name, `${number} ${unit}`);
  }
  if (asked.flag) parts.set("outside", "flag");
  if (asked.system !== "si") parts.set("units", asked.system);
  history.replaceState(null, "", `#${parts}`);
}

// The state of a link; what it names and is not here is told.
function takeLink() {
  const parts = new URLSearchParams(location.hash.slice(1));
  if (!parts.has("line")) return false;
  document.querySelector(`input[name=units][value=${parts.get("units") === "us" ? "us" : "si"}]`).checked = true;
  byId("flag").checked = parts.get("outside") === "flag";
  for (const name of Object.keys(DATA.levels)) {
    const [number, unit] = (parts.get(name) ?? "").split(" ");
    if (unit) STATE.levels[name] = [number, unit, true];
  }
  byId("find").value = "";
  refill(parts.get("line"), parts.get("quantity"), parts.get("branch"));
  if (byId("line").value !== parts.get("line")) {
    byId("said").prepend(element("p", `The link names a line that is not on this page: ${parts.get("line")}`, { class: "refused" }));
  }
  return true;
}

function refill(line, quantity, branch) {
  fillFilters();
  fillLines(line);
  fillQuantities(quantity);
  fillBranches(branch);
  makeLevels();
  show();
}

function about() {
  const campaigns = distinct(LINES.map((line) => line.group)).length - 1;
  byId("about").textContent = `${DATA.published.length} lines and tethers of published reports`
    + `${campaigns ? ` and ${LINES.length - DATA.published.length} lines of ${campaigns} campaign${campaigns > 1 ? "s" : ""}` : ""}, `
    + `with intervals, tested range and source. Made by mooring-reduction ${DATA.version}.`;
  const told = [
    ...DATA.faults.map(([campaign, file, text]) => `${campaign}: ${file} cannot be read: ${text}`),
    ...DATA.left_out.map(([campaign, count]) => `${campaign}: ${count} more archives have no room on this page; `
      + `reduction lookup processed/${campaign} has them`),
  ];
  byId("faults").hidden = !told.length;
  byId("faults").replaceChildren(...told.map((text) => element("li", text)));
}

function start() {
  about();
  makeFilters();
  for (const id of ["find", ...FILTERS.map(([name]) => `filter-${name}`)]) {
    byId(id).addEventListener("input", () => {
      fillLines();
      fillQuantities();
      fillBranches();
      makeLevels();
      show();
    });
  }
  byId("line").addEventListener("change", () => refillFrom(fillQuantities));
  byId("quantity").addEventListener("change", () => refillFrom(() => {}));
  byId("branch").addEventListener("change", () => {
    makeLevels();
    show();
  });
  byId("flag").addEventListener("change", show);
  for (const one of document.querySelectorAll("input[name=units]")) {
    one.addEventListener("change", () => refill());
  }
  byId("ask").addEventListener("submit", (event) => event.preventDefault());
  byId("copy-link").addEventListener("click", () => copy(location.href, "link"));
  byId("print").addEventListener("click", () => window.print());
  for (const one of document.querySelectorAll('a[href="#answer"]')) {
    one.addEventListener("click", (event) => {
      // the link of the page holds the state, and stays
      event.preventDefault();
      byId("answer").focus();
      byId("answer").scrollIntoView();
    });
  }
  window.addEventListener("hashchange", takeLink);
  if (!takeLink()) refill();
}

function refillFrom(first) {
  first();
  fillBranches();
  makeLevels();
  show();
}

start();
