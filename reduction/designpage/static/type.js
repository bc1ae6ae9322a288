// The line type: what is stated of the line, its files, and the commands that give the same.

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
  ["wet_linear_density", "The same in water", ["kg/m", "g/m"], ["lb/ft"], "linear_density"],
  ["diameter", "Diameter", ["mm"], ["in"], "length"],
];

function showType(line, asked, found) {
  if (!byId("type").open) return;
  if (STATE.statedOf !== line.key) {
    // a mass a length is that of one line
    STATE.stated = {};
    STATE.statedOf = line.key;
  }
  const forms = line.campaign ? ["table"] : ["table", "static-dynamic", "load-dependent"];
  const curves = Object.keys(line.export), of = `${line.key} ${asked.system}`;
  if (byId("type-stated").dataset.of !== of) {
    byId("type-stated").dataset.of = of;
    byId("type-stated").replaceChildren(
      choiceOf("form", "Form", forms),
      ...(curves.length > 1 ? [choiceOf("curve", "Curve", curves)] : []),
      ...STATED.map((one) => statedField(one, asked.system)));
  }
  const chosen = (name, options) => (options.includes(STATE[name]) ? STATE[name] : options[0]);
  showTypeText(line, asked, found, chosen("form", forms), chosen("curve", curves));
}

function choiceOf(name, title, options) {
  const box = element("div"), select = element("select", null, { id: `type-${name}` });
  box.append(element("label", title, { for: select.id }), select);
  fill(select, options.map((one) => [one, one]), STATE[name]);
  select.addEventListener("change", () => {
    STATE[name] = select.value;
    show();
  });
  return box;
}

function statedField([name, title, si, us], shownIn) {
  const units = shownIn === "us" ? us : si, before = STATE.stated[name];
  const isKept = before && units.includes(before[1]);
  const box = element("div"), input = element("input", null, { id: `stated-${name}`, type: "text", inputmode: "decimal" });
  const select = element("select", null, { "aria-label": `unit of ${title.toLowerCase()}` });
  fill(select, units.map((one) => [one, one]), isKept ? before[1] : units[0]);
  input.value = isKept ? before[0] : "";
  box.append(element("label", title, { for: input.id }), input, select);
  const typed = () => {
    STATE.stated[name] = [input.value.trim(), select.value];
  };
  typed();
  for (const [one, event] of [[input, "input"], [select, "change"]]) {
    one.addEventListener(event, () => {
      typed();
      show();
    });
  }
  return box;
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
