"use strict";
// what the report has beside its figures and this page has not: a chosen cycle, folded sections
const withCycle = (plot, figure) => figure;
const chooseAt = () => {};
const openForPaper = () => {};
const foldAgain = () => {};

(() => {
  const token = new URLSearchParams(location.search).get("token") ?? "";
  const part = (id) => document.getElementById(id);
  const OPEN = ["Trim and cycles", "Modulus windows", "Splice correction", "Steps"];
  const FROM = {
    test: "stated for this test", defaults: "from [defaults]", table: "stands in the table of tests: change it there",
    default: "not stated: the default", found: "not stated: found in the record",
  };
  const CURVES = /^(modulus|difference)-|^cycle$/;
  const PAUSE = 150; // a slider is at rest for so long before a change is asked for, in ms
  const wide = matchMedia("(min-width: 1100px)"); // settings stand beside the answers, and not above them
  const unsaved = new Map(); // changes by test, and in them texts by key
  const figures = new Map();
  const fields = new Map();
  let base = new Map(); // what campaign.toml says of the test that is shown, by key
  let shown = null;
  let newest = 0;
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
      return { error: "the explorer does not answer: it was ended in its terminal" };
    }
    try {
      return await answer.json();
    } catch {
      return { error: `the explorer answered ${answer.status}` };
    }
  };

  // a long log is told of while it is worked on, and nothing hangs
  const asked = async (path, document, number) => {
    let found = await post(path, document);
    while (found.state === "running") {
      if (number !== undefined && number !== newest) return null;
      say(`${found.stage} … ${found.seconds.toFixed(0)} s`);
      found = await post("/api/job", { job: found.job });
    }
    return number === undefined || (number === newest && found.state !== "superseded") ? found : null;
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
      if (!settings.length) part("settings").append(make("p", "No setting steers the reduction of a test of this kind.", { class: "small" }));
    }
    settings.forEach(setField);
  };

  const setAnswers = () => {
    const table = shown?.answers;
    if (!table) {
      part("answers").replaceChildren(make("p", "There is no number to show."));
      return;
    }
    const isMoved = (cells) => Number(cells[4].value) !== 0 || !cells[4].value && cells[1].text !== cells[2].text;
    const picked = shown.diff && part("moved").checked ? table.rows.filter(isMoved) : table.rows;
    const box = make("div", "", { class: "table compact", role: "group", tabindex: "0", "aria-label": table.caption });
    const grid = make("table");
    const caption = make("caption");
    const left = table.rows.length - picked.length;
    caption.append(make("span", left ? `${table.caption} ${left} of ${table.rows.length} numbers do not move.` : table.caption));
    const head = make("tr");
    head.append(...table.columns.map((name, place) => make("th", name, { scope: "col", class: table.numbers[place] ? "number" : "" })));
    const body = make("tbody");
    for (const cells of picked) {
      const row = make("tr");
      row.append(...cells.map((cell, place) => place === 0
        ? make("th", cell.text, { scope: "row" })
        : make("td", cell.text, { class: table.numbers[place] ? "number" : "", "data-value": cell.value })));
      if (isMoved(cells)) row.classList.add("moved");
      body.append(row);
    }
    const top = make("thead");
    top.append(head);
    grid.append(caption, top, body);
    box.append(grid);
    part("answers").replaceChildren(box, ...table.remarks.map((text) => make("p", text, { class: "small under" })));
  };

  const makeSlot = (key) => {
    const slot = {
      figure: make("figure", "", { id: `figure-${key}` }),
      plot: make("div", "", { class: "plot", role: "group", "data-figure": `${key}-data` }),
      caption: make("figcaption"),
      data: make("script", "", { type: "application/json", id: `${key}-data` }),
    };
    slot.figure.append(slot.plot, slot.caption, slot.data);
    figures.set(key, slot);
    return slot;
  };

  // a figure keeps its place and what a reader zoomed; only its lines change
  const setFigures = (wanted) => {
    const keys = new Set(wanted.map((one) => one.key));
    figures.forEach((slot, key) => { slot.figure.hidden = !keys.has(key); });
    for (const one of wanted) {
      const slot = figures.get(one.key) ?? makeSlot(one.key);
      slot.figure.classList.toggle("wide", one.wide);
      slot.plot.setAttribute("aria-label", one.label);
      slot.plot.dataset.height = one.height;
      if (!drawn.has(slot.plot)) slot.plot.style.minHeight = `${one.height}px`;
      slot.caption.textContent = one.caption;
      slot.data.textContent = one.json;
    }
    for (const [id, isOwn] of [["curves", true], ["figures", false]]) {
      const own = wanted.filter((one) => CURVES.test(one.key) === isOwn).map((one) => figures.get(one.key).figure);
      const there = [...part(id).children].filter((figure) => !figure.hidden);
      if (own.some((figure, place) => figure !== there[place])) part(id).append(...own);
    }
    part("curves-section").hidden = !wanted.some((one) => CURVES.test(one.key));
    for (const one of wanted) {
      const { plot } = figures.get(one.key);
      near.observe(plot);
      if (drawn.has(plot)) drawAgain(plot);
    }
  };

  const mark = (error) => {
    fill("error", error);
    for (const [key, { entry }] of fields) entry.setAttribute("aria-invalid", String(Boolean(error) && error.includes(key) && changes().has(key)));
  };

  const show = (found) => {
    shown = found;
    if (!changes().size) base = new Map(found.settings.map((one) => [one.key, one.value]));
    setSettings(found.settings);
    setAnswers();
    setFigures(found.figures);
    mark(found.error);
    part("disk").hidden = !found.is_changed_on_disk;
    fill("standing", found.is_standing ? "" : "The archive of this test is of other settings, another log or another version than campaign.toml now: reduction run brings it up to date. What is shown is reduced from the raw log.");
    part("notes-section").hidden = !found.notes.length;
    part("notes-summary").textContent = `Every note of this test as changed (${found.notes.length})`;
    part("notes").replaceChildren(...found.notes.map((text) => make("li", text)));
    const long = found.is_slow ? `; a log of ${found.rows.toLocaleString("en")} rows takes so long for each change` : "";
    const many = changes().size;
    say(`${many ? `${many} ${many === 1 ? "setting" : "settings"} changed, not saved. ` : "As campaign.toml is. "}Reduced in ${found.seconds.toFixed(1)} s${long}.`);
  };

  const change = async () => {
    clearTimeout(timer);
    const number = ++newest;
    document.body.classList.add("busy");
    say("at work …");
    const found = await asked("/api/change", { test: test(), changes: Object.fromEntries(changes()) }, number);
    if (!found) {
      // what a page beside this one asked for was newer
      if (number === newest) {
        document.body.classList.remove("busy");
        say("Another page of this explorer was quicker. Move a setting, or choose the test, again.");
      }
      return;
    }
    document.body.classList.remove("busy");
    if (found.settings) show(found);
    else {
      shown = null;
      mark(found.error);
      say("This cannot be reduced; the figures are those of before.");
      for (const [key, { row, from }] of fields) {
        row.classList.toggle("changed", changes().has(key));
        if (changes().has(key)) from.textContent = "changed here, not saved";
      }
    }
    part("undo").disabled = changes().size === 0;
    part("review").disabled = !(shown && shown.diff);
  };

  // the first change of a test is none: it says what campaign.toml has
  const open = async () => {
    const kept = changes();
    unsaved.delete(test());
    await change();
    if (kept.size && shown) {
      unsaved.set(test(), kept);
      await change();
    }
  };

  const start = async (path) => {
    const campaign = await asked(path, {});
    if (!campaign.tests) {
      fill("error", campaign.error);
      say("The campaign cannot be shown.");
      return;
    }
    fill("error", "");
    setTests(campaign);
    if (campaign.tests.length) await open();
    else say("The campaign has no tests.");
  };

  const review = () => {
    part("diff").replaceChildren(...shown.diff.split("\n").flatMap((text) => {
      const kind = /^\+(?!\+\+)/.test(text) ? "plus" : /^-(?!--)/.test(text) ? "minus" : "";
      return [make("span", text, { class: kind }), "\n"];
    }));
    fill("also", shown.also.length ? `Other tests rest on this one, or on its marks, and a run makes them anew too: ${shown.also.join(", ")}.` : "");
    part("save").showModal();
  };

  const write = async () => {
    part("write").disabled = true;
    const { before, after } = shown;
    const found = await asked("/api/save", { test: test(), changes: Object.fromEntries(changes()), before, after });
    part("write").disabled = false;
    part("save").close();
    if (found.error) {
      fill("error", found.error);
      part("disk").hidden = false;
      return;
    }
    unsaved.delete(test());
    await open();
    say(`Written: ${found.saved}. Run the campaign to bring the archive up to date.`);
  };

  part("test").addEventListener("change", open);
  part("moved").addEventListener("change", setAnswers);
  part("settings").addEventListener("submit", (sent) => sent.preventDefault());
  part("undo").addEventListener("click", () => { unsaved.delete(test()); open(); });
  part("review").addEventListener("click", review);
  part("write").addEventListener("click", write);
  part("cancel").addEventListener("click", () => part("save").close());
  part("reload").addEventListener("click", () => { unsaved.clear(); start("/api/reload"); });
  addEventListener("beforeunload", (leaving) => {
    if ([...unsaved.values()].some((one) => one.size)) leaving.preventDefault();
  });
  start("/api/campaign");
})();
