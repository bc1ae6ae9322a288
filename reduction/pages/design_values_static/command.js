// The commands that give the same, and the decks for mooring codes.

function quoted(text) {
  return /^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}

function levelsOf(asked) {
  return Object.entries(asked.levels).map(([name, [number, unit]]) => (
    `--${name.replaceAll("_", "-")} "${unit === "1" ? number : `${number} ${unit}`}"`));
}

function commandOf(line, asked) {
  const parts = line.campaign
    ? [quoted(`processed/${line.campaign}`), "--line", quoted(line.name)] : [quoted(line.name)];
  parts.push(...levelsOf(asked));
  if (asked.branch) parts.push("--branch", asked.branch);
  if (asked.flag) parts.push("--extrapolate", "flag");
  if (asked.system === "us") parts.push("--units", "us");
  return `reduction lookup ${parts[0]} --quantity ${asked.quantity} ${parts.slice(1).join(" ")}`;
}

// Surfaces of a campaign are of several tests and are no line type, at the command either.
function isExported(line) {
  return !(line.campaign && Object.keys(line.surfaces).length);
}

// One command a form of a MoorDyn line type: its curve, and its stiffness at the levels of a cycle.
function exportCommandsOf(line, asked) {
  const source = line.campaign
    ? [quoted(`processed/${line.campaign}/${line.test}.nc`), "--specimen", quoted(line.specimen),
      "--curve", asked.branch ?? "mean"] : [quoted(line.name)];
  const name = line.campaign ? `${line.test}-${line.specimen}` : line.name;
  const file = `${name.replaceAll(/[^A-Za-z0-9_]+/g, "_").replaceAll(/^_+|_+$/g, "")}_line.dat`;
  const stated = Number.isFinite(line.linear_density) ? [] : ['--linear-density "... kg/m"'];
  const to = (...more) => (
    ["reduction export", ...source, "--to moordyn", ...stated, ...more, `--out ${file}`].join(" "));
  const isCycle = !line.campaign && "mean_tension" in asked.levels && "tension_amplitude" in asked.levels;
  const flag = asked.flag ? ["--extrapolate flag"] : [];
  const forms = isCycle ? ["static-dynamic", "load-dependent"] : [];
  return [to("--form table"), ...forms.map((form) => to(`--form ${form}`, ...levelsOf(asked), ...flag))];
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
