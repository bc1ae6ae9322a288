"use strict";
// what the report has beside its figures and this page has not: a chosen cycle, folded sections
const withCycle = (plot, figure) => figure;
const chooseAt = () => {};
const openForPaper = () => {};
const foldAgain = () => {};

(() => {
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const part = (id) => document.getElementById(id);
  const OPEN = ["Trim and cycles", "Modulus windows", "Splice correction", "Steps"]; // groups of settings
  const FROM = {
    test: "stated for this test", defaults: "from [defaults]", table: "from the table of tests (tests.csv): change it there",
    default: "not stated: the default", found: "not stated: found in the record",
  };
  const PAUSE = 150; // a slider is at rest for so long before a change is asked for, in ms
  const wide = matchMedia("(min-width: 1100px)"); // settings stand beside the answers, and not above them
  const unsaved = new Map(); // changes by test, and in them texts by key
  const fields = new Map();
  let base = new Map(); // what campaign.toml says of the test that is shown, by key
  let standing = null; // what it gives
  let shown = null; // the same, or what the changes give
  let isBusy = false;
  let isWanted = false; // something newer, while the last is worked on
  let timer = 0;

  const make = (name, text = "", attributes = {}) => {
    const element = document.createElement(name);
    element.textContent = text;
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
  };
  const fill = (id, text) => { part(id).textContent = text; part(id).hidden = !text; };
  const say = (text) => { part("status").textContent = text; };
  const test = () => part("test").value;
  const changes = () => unsaved.get(test()) ?? new Map();

  const post = async (path, document) => {
    let answer;
    try {
      answer = await fetch(path, {
        method: "POST", body: JSON.stringify(document), cache: "no-store",
        headers: { "Content-Type": "application/json", Authorization: `Bearer ${token}` },
      });
    } catch {
      return { error: "the explorer does not answer: it was stopped in its terminal" };
    }
    try {
      return await answer.json();
    } catch {
      return { error: `the explorer answered ${answer.status}` };
    }
  };

  const setTests = (campaign) => {
    document.title = `Explore ${campaign.campaign}`;
    part("campaign").textContent = campaign.campaign;
    part("title").textContent = campaign.title || campaign.campaign;
    part("file").textContent = campaign.file;
    part("save-file").textContent = campaign.file;
    part("synthetic").hidden = !campaign.synthetic;
    const before = test();
    part("test").replaceChildren(...campaign.tests.map((one) => {
      const said = one.error ? "cannot be read" : `${one.rows.toLocaleString("en")} rows`;
      return make("option", `${one.id}: ${one.kind}, ${said}`, { value: one.id });
    }));
    if (campaign.tests.some((one) => one.id === before)) part("test").value = before;
    part("test").disabled = campaign.tests.length === 0;
  };

  const setField = (setting) => {
    const { row, entry, range, from, reset } = fields.get(setting.key);
    const own = changes().has(setting.key);
    if (document.activeElement !== entry) entry.value = own ? changes().get(setting.key) : setting.value;
    if (entry.tagName === "SELECT") {
      entry.options[0].textContent = setting.value ? "as found, or by [defaults]" : `${setting.shown || "found"} (${FROM[setting.place]})`;
    } else {
      entry.placeholder = setting.shown || "found";
    }
    entry.disabled = reset.disabled = setting.place === "table";
    if (range && setting.slider) {
      const { low, high, step, value } = setting.slider;
      range.disabled = setting.place === "table";
      if (document.activeElement !== range) {
        Object.assign(range, { min: low, max: high, step: "any" });
        range.value = value;
        range.step = step;
        range.setAttribute("aria-valuetext", setting.value || setting.shown);
      }
    }
    from.textContent = own ? "changed here, not saved" : FROM[setting.place];
    row.classList.toggle("changed", own);
    reset.hidden = !(entry.value || own);
  };

  const move = (key, text) => {
    const now = new Map(changes());
    if (text === (now.get(key) ?? base.get(key) ?? "")) return; // left as it was
    if (text === (base.get(key) ?? "")) now.delete(key);
    else now.set(key, text);
    unsaved.set(test(), now);
    part("review").disabled = true; // until what follows is seen
    clearTimeout(timer);
    timer = setTimeout(change, PAUSE);
  };

  const makeField = (setting) => {
    const id = `setting-${setting.key.replaceAll(".", "-")}`;
    const row = make("div", "", { class: "setting" });
    const label = make("label", setting.words, { for: id });
    const name = make("code", setting.key);
    const from = make("p", "", { class: "from", id: `${id}-from` });
    const reset = make("button", "×", { type: "button", title: "Leave it out", "aria-label": `Leave out ${setting.key}` });
    const described = { id, "aria-describedby": `${id}-from` };
    let entry;
    let range = null;
    if (setting.choices.length) {
      entry = make("select", "", described);
      entry.append(make("option", "", { value: "" }), ...setting.choices.map((one) => make("option", one, { value: one })));
    } else {
      entry = make("input", "", { ...described, type: "text", spellcheck: "false", maxlength: "200" });
    }
    const line = make("div", "", { class: "entry" });
    line.append(entry, reset);
    row.append(label, name);
    if (setting.slider) {
      range = make("input", "", { type: "range", "aria-label": `${setting.key}: ${setting.words}` });
      range.addEventListener("input", () => {
        const digits = (String(setting.slider.step).split(".")[1] ?? "").length;
        const number = Number(Number(range.value).toFixed(digits));
        entry.value = setting.slider.unit ? `${number} ${setting.slider.unit}` : String(number);
        range.setAttribute("aria-valuetext", entry.value);
        move(setting.key, entry.value);
      });
      row.append(range);
    }
    entry.addEventListener("change", () => move(setting.key, entry.value.trim()));
    entry.addEventListener("keydown", (pressed) => { if (pressed.key === "Enter") pressed.preventDefault(), move(setting.key, entry.value.trim()); });
    reset.addEventListener("click", () => { entry.value = ""; entry.focus(); move(setting.key, ""); });
    row.append(line, from);
    fields.set(setting.key, { row, entry, range, from, reset });
    return row;
  };

  const setSettings = (settings) => {
    const keys = settings.map((one) => one.key).join();
    if (part("settings").dataset.keys !== keys) {
      fields.clear();
      const groups = new Map();
      for (const one of settings) {
        if (!groups.has(one.group)) {
          const group = make("details");
          group.append(make("summary", one.group));
          group.open = wide.matches && OPEN.includes(one.group);
          groups.set(one.group, group);
        }
        groups.get(one.group).append(makeField(one));
      }
      part("settings").replaceChildren(...groups.values());
      part("settings").dataset.keys = keys;
      if (!settings.length) part("settings").append(make("p", "No setting affects a test of this kind.", { class: "small" }));
    }
    settings.forEach(setField);
  };

  // headings of the report's section with what stands below each, and its text by which a change is seen
  const partsOf = (html) => {
    const parts = new Map();
    const holder = make("template");
    holder.innerHTML = html; // of the report, where every name is escaped; the page runs no script out of it
    let name = null;
    for (const child of [...holder.content.querySelector("section")?.children ?? []]) {
      if (child.matches(".notes, .provenance")) name = child.className;
      if (child.matches("h3")) name = child.textContent;
      if (name === null) continue;
      const own = parts.get(name) ?? { nodes: [], text: "", heading: null };
      parts.set(name, own);
      if (child.matches("h3")) own.heading = child;
      else own.nodes.push(child);
      own.text += child.outerHTML.replaceAll(/\b(standing|changed)-/g, "");
    }
    return parts;
  };

  // rows are the same where their words are; numbers that another run of the report would print are marked
  const markMoved = (before, after) => {
    const rowsOf = (table) => {
      const rows = new Map();
      for (const row of table?.rows ?? []) {
        const words = [...row.cells].filter((cell) => !cell.matches(".number")).map((cell) => cell.textContent).join("|");
        rows.set(rows.has(words) ? `${words}|${rows.size}` : words, row);
      }
      return rows;
    };
    const tables = [...before.querySelectorAll("table")];
    [...after.querySelectorAll("table")].forEach((table, place) => {
      const old = rowsOf(tables[place]);
      for (const [words, row] of rowsOf(table)) {
        [...row.cells].forEach((cell, column) => {
          const was = old.get(words)?.cells[column];
          cell.classList.toggle("moved", Boolean(was) && was.textContent !== cell.textContent);
        });
      }
    });
  };

  const sideOf = (name, words, part) => {
    const side = make("div", "", { class: name });
    side.append(make("p", words, { class: "side" }), ...part?.nodes ?? [make("p", "There is no such part.", { class: "small" })]);
    return side;
  };

  const blockOf = (name, old, now) => {
    const block = make("div", "", { class: "part" });
    const heading = (now ?? old).heading ?? old?.heading;
    if (shown === standing) {
      block.append(...heading ? [heading] : [], ...old.nodes);
    } else if (old && now && old.text === now.text) {
      const same = make("details", "", { class: "same" });
      if (heading) same.append(make("summary", `${heading.textContent}: nothing moved`), ...old.nodes);
      block.append(...heading ? [same] : old.nodes);
    } else {
      const pair = make("div", "", { class: "pair" });
      pair.append(sideOf("old", "As it is", old), sideOf("new", "Changed", now));
      block.append(...heading ? [heading] : [], pair);
      markMoved(pair.firstChild, pair.lastChild);
    }
    return block;
  };

  // what was drawn of the file on the disk keeps its place and what a reader zoomed
  const setParts = () => {
    const before = new Set(part("parts").querySelectorAll(".plot"));
    const names = new Set([...shown.parts.keys(), ...standing.parts.keys()]);
    const isOpen = new Set([...part("parts").querySelectorAll(".same[open] > summary")].map((one) => one.textContent));
    const blocks = [...names].map((name) => blockOf(name, standing.parts.get(name), shown.parts.get(name)));
    part("parts").replaceChildren(...blocks.length ? blocks : [make("p", "There is nothing to show.")]);
    for (const one of part("parts").querySelectorAll(".same > summary")) one.parentElement.open = isOpen.has(one.textContent);
    for (const plot of before) {
      if (plot.isConnected) {
        if (drawn.has(plot)) drawAgain(plot); // as wide as its column is now
        continue;
      }
      near.unobserve(plot);
      [inSight, stale].forEach((one) => one.delete(plot));
      if (drawn.has(plot)) forget(plot);
    }
    for (const plot of part("parts").querySelectorAll(".plot")) near.observe(plot);
  };

  const mark = (error) => {
    fill("error", error);
    for (const [key, { entry }] of fields) entry.setAttribute("aria-invalid", String(Boolean(error) && error.includes(key) && changes().has(key)));
  };

  const show = (found) => {
    shown = found;
    shown.parts ??= partsOf(found.section);
    setSettings(found.settings);
    setParts();
    mark(found.error);
    fill("standing", standing.is_standing ? "" : "The archive of this test was made with other settings, another log or another version: reduction run updates it. This page shows results from the raw log.");
    const many = changes().size;
    say(`${many ? `${many} ${many === 1 ? "setting" : "settings"} changed, not saved. ` : "As campaign.toml is. "}Reduced in ${found.seconds.toFixed(1)} s.`);
  };

  const refuse = (error) => {
    if (shown?.test !== test()) part("parts").replaceChildren();
    shown = null;
    mark(error);
    say("This cannot be reduced; the page shows the previous results.");
    for (const [key, { row, from }] of fields) {
      row.classList.toggle("changed", changes().has(key));
      if (changes().has(key)) from.textContent = "changed here, not saved";
    }
  };

  // what campaign.toml gives is asked for once, and what the changes give beside it
  const asked = async () => {
    const id = test();
    if (standing?.test !== id) {
      const found = await post("/api/change", { test: id, changes: {} });
      if (!found.settings) return found;
      standing = found;
      standing.parts = partsOf(found.section);
      base = new Map(found.settings.map((one) => [one.key, one.value]));
    }
    return changes().size ? post("/api/change", { test: id, changes: Object.fromEntries(changes()) }) : standing;
  };

  const change = async () => {
    clearTimeout(timer);
    isWanted = true;
    if (isBusy) return;
    isBusy = true;
    document.body.classList.add("busy");
    let found;
    const begun = Date.now();
    say("reducing …");
    const clock = setInterval(() => say(`reducing … ${Math.round((Date.now() - begun) / 1000)} s`), 1000);
    while (isWanted) {
      isWanted = false;
      found = await asked();
    }
    clearInterval(clock);
    isBusy = false;
    document.body.classList.remove("busy");
    if (found.settings) show(found);
    else refuse(found.error);
    part("disk").hidden = !found.error?.includes("changed on the disk");
    part("undo").disabled = changes().size === 0;
    part("review").disabled = !(shown && shown.diff);
  };

  const start = async (path) => {
    const campaign = await post(path, {});
    if (!campaign.tests) {
      fill("error", campaign.error);
      say("The campaign cannot be shown.");
      return;
    }
    fill("error", "");
    standing = null;
    setTests(campaign);
    if (campaign.tests.length) await change();
    else say("The campaign has no tests.");
  };

  const review = () => {
    part("diff").replaceChildren(...shown.diff.split("\n").flatMap((text) => {
      const kind = /^\+(?!\+\+)/.test(text) ? "plus" : /^-(?!--)/.test(text) ? "minus" : "";
      return [make("span", text, { class: kind }), "\n"];
    }));
    fill("also", shown.also.length ? `Other tests depend on this one or on its marks; a run will redo them too: ${shown.also.join(", ")}.` : "");
    part("save").showModal();
  };

  const write = async () => {
    part("write").disabled = true;
    const { before, after } = shown;
    const found = await post("/api/save", { test: test(), changes: Object.fromEntries(changes()), before, after });
    part("write").disabled = false;
    part("save").close();
    if (found.error) {
      fill("error", found.error);
      part("disk").hidden = false;
      return;
    }
    unsaved.delete(test());
    standing = null;
    await change();
    say(`Written: ${found.saved}. Run the campaign to bring the archive up to date.`);
  };

  part("test").addEventListener("change", change);
  part("settings").addEventListener("submit", (sent) => sent.preventDefault());
  part("undo").addEventListener("click", () => { unsaved.delete(test()); change(); });
  part("review").addEventListener("click", review);
  part("write").addEventListener("click", write);
  part("cancel").addEventListener("click", () => part("save").close());
  part("reload").addEventListener("click", () => { unsaved.clear(); start("/api/reload"); });
  addEventListener("beforeunload", (leaving) => {
    if ([...unsaved.values()].some((one) => one.size)) leaving.preventDefault();
  });
  start("/api/campaign");
})();
