"use strict";
(() => {
  const form = document.getElementById("filter");
  const report = document.getElementById("report");
  const words = document.getElementById("words");
  const shown = document.getElementById("shown");
  const ticks = [...form.querySelectorAll("input[name=verdict]")];
  const sections = [...document.querySelectorAll("section.report")].map((section) => ({
    section,
    tables: [...section.querySelectorAll("details.cells")].map((details) => ({
      details,
      name: details.querySelector("caption").textContent.toLowerCase(),
      rows: [...details.querySelectorAll("tbody tr")].map((row) => ({ row, text: row.textContent.toLowerCase() })),
    })),
  }));
  const all = sections.flatMap((one) => one.tables).reduce((sum, table) => sum + table.rows.length, 0);

  const apply = () => {
    const wanted = new Set(ticks.filter((tick) => tick.checked).map((tick) => tick.value));
    const asked = words.value.toLowerCase().split(",").map((word) => word.trim()).filter(Boolean);
    const filtered = wanted.size < ticks.length || asked.length > 0;
    let count = 0;
    for (const { section, tables } of sections) {
      const inReport = !report.value || report.value === section.dataset.report;
      let inSection = 0;
      for (const { details, name, rows } of tables) {
        let visible = 0;
        for (const { row, text } of rows) {
          const whole = `${name} ${text}`;
          const is = wanted.has(row.dataset.verdict)
            && (!asked.length || asked.some((word) => whole.includes(word)));
          row.hidden = !is;
          visible += is;
        }
        details.hidden = visible === 0;
        details.open = filtered && visible > 0;
        inSection += visible;
      }
      section.hidden = !inReport || inSection === 0;
      if (inReport) count += inSection;
    }
    shown.textContent = `${count.toLocaleString("en")} of ${all.toLocaleString("en")} cells`;
  };

  form.hidden = false;
  let pending = 0;
  const soon = () => { clearTimeout(pending); pending = setTimeout(apply, 150); };
  form.addEventListener("input", soon);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => setTimeout(apply));
  for (const link of document.querySelectorAll("a[data-only]")) {
    link.addEventListener("click", () => {
      ticks.forEach((tick) => { tick.checked = !link.dataset.only || tick.value === link.dataset.only; });
      apply();
    });
  }
  // what a link leads to may be folded, or filtered away with its report
  const unfold = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    if (!target) return;
    if (target.closest("section[hidden]")) {
      form.reset();
      apply();
    }
    const folded = target.closest("details");
    if (folded) folded.open = true;
    target.scrollIntoView();
  };
  addEventListener("hashchange", unfold);
  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[href^='#']:not([data-only])");
    if (link && link.hash === location.hash) setTimeout(unfold);
  });
  addEventListener("beforeprint", () => {
    document.querySelectorAll("details").forEach((part) => { part.open = !part.hidden; });
  });
  apply();
  if (location.hash) unfold();
})();
