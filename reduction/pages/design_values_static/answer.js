// The answer: value, flags or refusal, figures, source, notes and errata.

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
    const isOfStrength = head === "value\n[MBL]";
    const cell = element(head.startsWith("value") && !isOfStrength ? "strong" : "span", head === "remark" ? text : grouped(text), { "data-head": head });
    const words = head.replaceAll("\n", " ").trim(), [, name, unit] = words.match(/^(.*?) ?(?:\[(.*)\])?$/);
    if (isOfStrength) {
      box.lastChild.append(" (", cell, " MBL)");
    } else if (head.startsWith("value")) {
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
      last.append(cell, ` ${unit === "% of residual strength" ? "% of the residual strength" : unit}`);
      at.append(element("dt", name), last);
    }
  }
  if (intervals.childElementCount) box.append(intervals);
  else box.append(element("p", "no interval: the notes say why", { class: "small" }));
  box.append(at);
  return box;
}

// A table behind the answer, under the words that lead to it.
function showTable({ intro, heads, rows }) {
  const box = element("div", null, { class: "table", tabindex: "0", role: "region", "aria-label": intro || "K_0, K_1 and tau" }), table = element("table"), head = element("tr");
  if (intro) box.append(element("p", intro[0].toUpperCase() + intro.slice(1), { class: "small" }));
  head.append(...heads.map((text) => element("th", text.replaceAll("\n", " ").trim(), { scope: "col" })));
  table.append(head, ...rows.map((cells) => {
    const row = element("tr");
    row.append(...cells.map((text) => element("td", grouped(text))));
    return row;
  }));
  box.append(table);
  return box;
}

function showRefusal(said, asked) {
  const { refusal } = asked;
  const box = element("div", null, { class: "refused" });
  const hint = (refusal.hint ?? "").replace(FLAG_HINT, "").replace(/\. $/, ".").trim();
  const texts = [refusal.found && `found ${refusal.found}`, refusal.needed && `needed ${refusal.needed}`, hint].filter(Boolean);
  box.append(element("p", "Refused", { class: "refused-title" }), element("p", refusal.problem), listOf(texts));
  if ((refusal.hint ?? "").includes(FLAG_HINT)) {
    box.append(element("p", "“Allow values outside the tested range, flagged” gives the number and flags it.", { class: "small" }));
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
    byId("answer-title").textContent = line ? line.name : "No line found";
    said.append(element("p", line ? "This line has no values to look up." : "No line matches all filters and words: remove one."));
    if (line) showAbsent(line);
    byId("decks").hidden = true;
    brief("");
    return;
  }
  byId("decks").hidden = !isExported(line);
  byId("answer-title").textContent = `${titleOf(asked.quantity)}: ${line.name}`;
  keepLink(asked);
  byId("command").textContent = commandOf(line, asked);
  byId("export").textContent = exportCommandsOf(line, asked).join("\n");
  if (asked.bad) {
    said.append(element("p", `${asked.bad.replaceAll("_", " ")} is not a number`, { class: "refused-title" }));
    brief("Not a number");
    return;
  }
  const found = answer(asked);
  if (found.refusal) {
    showRefusal(said, found);
    brief("Refused: why");
  } else {
    const remarks = remarksOf(found.found), [unit, factor] = displayUnit(found.found.unit, asked.system);
    brief(`${symbolOf(asked.quantity)} ${grouped(valueText(found.found, factor))} ${unit === "1" ? "" : unit}${remarks.length ? " (flagged)" : ""}`);
    if (remarks.length) {
      const flags = listOf(remarks);
      flags.className = "flags";
      said.append(flags);
    }
    if (found.warnings.length) {
      const warnings = listOf(found.warnings);
      warnings.className = "warnings";
      said.append(warnings);
    }
    said.append(showRow(found.row), ...found.tables.map(showTable));
  }
  const levels = tableOfLevels(line, asked.system);
  if (levels) said.append(showTable(levels));
  showCharts(line, asked, found);
  showNotes(line, asked, found);
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
      ? "Light band: 95 % of one more run; dark band: 95 % of the surface, or of this test. " : "";
    const others = Object.keys(asked.levels).length > 1 ? " The other levels stay as chosen." : "";
    byId("charts").append(element("p", `${bands}Grey: not tested.${others}`, { class: "small legend" }));
  }
}

function showAbsent(line) {
  const missing = Object.entries(line.absent).filter(([name]) => !line.quantities.includes(name));
  if (!missing.length) return;
  byId("notes").append(element("h3", "Not available for this line"),
    listOf(missing.map(([name, why]) => `${name.replaceAll("_", " ")}: ${why}`)));
}

function showNotes(line, asked, found) {
  const notes = byId("notes"), facts = element("dl", null, { class: "facts" });
  const fact = (name, text) => text && facts.append(element("dt", name), element("dd", text));
  const report = Object.hasOwn(DATA.reports, line.campaign) ? DATA.reports[line.campaign] : "";
  const [force, scale] = displayUnit("N", asked.system);
  const printed = asked.quantity === DASHPOT ? [SPRING, TIME] : [asked.quantity];
  fact("source", line.printed
    ? distinct(printed.map((name) => line.printed[name] ?? line.source)).join("; ") : line.source);
  fact("campaign", line.campaign);
  if (report) facts.lastChild.append(" (", element("a", "its report", { href: report }), ")");
  fact("material", line.material);
  fact("construction", line.construction);
  fact("condition", line.condition);
  fact("diameter", diameterOf(line));
  if (Number.isFinite(line.rated_break_strength)) {
    fact("%RBS is of", `${grouped(short(scale * line.rated_break_strength))} ${force}${line.strength_of ? ` (${line.strength_of})` : ""}`);
  }
  if (Number.isFinite(line.tensile_strength)) fact("residual strength", `${grouped(short(scale * line.tensile_strength))} ${force}`);
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
