// The link that holds the question, and the start.

function linkOf(asked) {
  const parts = new URLSearchParams({ line: asked.line, quantity: asked.quantity });
  if (asked.branch) parts.set("branch", asked.branch);
  for (const name of Object.keys(asked.levels)) parts.set(name, STATE.levels[name].slice(0, 2).join(" "));
  if (asked.flag) parts.set("outside", "flag");
  if (asked.system !== "si") parts.set("units", asked.system);
  return `#${parts}`;
}

function keepLink(asked) {
  try {
    history.replaceState(null, "", linkOf(asked));
  } catch {
    // a browser may let a page change its address only so often; the button copies the link all the same
  }
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
  const reports = Object.entries(DATA.reports);
  byId("reports").hidden = !reports.length;
  byId("reports").replaceChildren("Reports: ", ...reports.flatMap(([campaign, address], place) => (
    [...(place ? [", "] : []), element("a", campaign, { href: address })])));
  const told = [
    ...DATA.faults.map(([campaign, file, text]) => `${campaign}: ${file} cannot be read: ${text}`),
    ...DATA.left_out.map(([campaign, count]) => `${campaign}: ${count} more archives have no room on this page; `
      + `reduction lookup processed/${campaign} has them`),
  ];
  byId("faults").hidden = !told.length;
  byId("faults").replaceChildren(...told.map((text) => element("li", text)));
}

function refillFrom(first) {
  first();
  fillBranches();
  makeLevels();
  show();
}

function start() {
  about();
  makeFilters();
  for (const id of ["find", ...FILTERS.map(([name]) => `filter-${name}`)]) {
    byId(id).addEventListener("input", () => refillFrom(() => {
      fillLines();
      fillQuantities();
    }));
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
  byId("copy-link").addEventListener("click", () => {
    const asked = query();
    copy(location.href.split("#")[0] + (asked ? linkOf(asked) : ""), "link");
  });
  byId("copy-export").addEventListener("click", () => copy(byId("export").textContent, "commands"));
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

start();
