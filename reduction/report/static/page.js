"use strict";
(() => {
  const plots = [...document.querySelectorAll(".plot")];
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const drawn = new Set();
  const PRINT_WIDTH = 660; // what an A4 or Letter page with 15 mm margins holds, in CSS pixels

  const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  const themed = (layout) => {
    const colours = { font: ink("--ink"), faint: ink("--faint"), grid: ink("--grid"), paper: ink("--paper") };
    const result = {
      ...layout,
      autosize: true,
      paper_bgcolor: colours.paper,
      plot_bgcolor: colours.paper,
      font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: colours.font },
      margin: { l: 64, r: 16, t: layout.title.subtitle ? 62 : 44, b: 48 },
      legend: { orientation: "h", x: 0, y: -0.16, yanchor: "top", font: { size: 11 }, ...layout.legend },
      hoverlabel: { namelength: 40 },
      hovermode: "closest",
      title: { ...layout.title, x: 0.01, xanchor: "left", y: 0.98, yanchor: "top", yref: "container", font: { size: 14 } },
    };
    if (layout.title.subtitle) {
      result.title.subtitle = { ...layout.title.subtitle, font: { size: 11, color: ink("--bad") } };
    }
    for (const name of Object.keys(layout)) {
      if (/^[xy]axis/.test(name)) {
        result[name] = {
          gridcolor: colours.grid, zerolinecolor: colours.grid, linecolor: colours.faint,
          showline: true, ticks: "outside", tickcolor: colours.faint, automargin: true, ...layout[name],
        };
      }
    }
    return result;
  };

  // a legend under the axes takes its height from the plot unless the figure grows with it
  const height = (plot, data, width) => {
    const entries = data.filter((trace) => trace.showlegend !== false);
    const longest = Math.max(0, ...entries.map((trace) => trace.name.length));
    const columns = Math.max(1, Math.floor((width - 80) / (52 + 6.2 * longest)));
    const rows = entries.length > 1 ? Math.ceil(entries.length / columns) : 0;
    return Number(plot.dataset.height) + 19 * rows;
  };

  const draw = (plot) => {
    const { data, layout } = JSON.parse(document.getElementById(plot.dataset.figure).textContent);
    const tall = height(plot, data, plot.clientWidth);
    plot.style.minHeight = `${tall}px`;
    const entries = data.filter((trace) => trace.showlegend !== false).length;
    const shown = { ...themed(layout), height: tall, showlegend: entries > 1 };
    shown.legend.y = -62 / (Number(plot.dataset.height) - 110);
    drawn.add(plot);
    return Plotly.react(plot, data, shown, {
      responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"],
      toImageButtonOptions: { format: "svg", filename: plot.parentElement.id },
    });
  };

  const drawAll = () => plots.filter((plot) => !drawn.has(plot)).forEach(draw);

  const near = new IntersectionObserver((seen) => {
    for (const entry of seen) {
      if (entry.isIntersecting) {
        near.unobserve(entry.target);
        if (!drawn.has(entry.target)) draw(entry.target);
      }
    }
  }, { rootMargin: "600px" });
  plots.forEach((plot) => near.observe(plot));

  dark.addEventListener("change", () => drawn.forEach(draw));
  document.getElementById("draw-all").addEventListener("click", drawAll);

  const forPaper = () => {
    document.querySelectorAll("details").forEach((part) => { part.open = true; });
    drawAll();
    drawn.forEach((plot) => Plotly.relayout(plot, {
      width: PRINT_WIDTH, autosize: false, paper_bgcolor: "#fff", plot_bgcolor: "#fff", "font.color": "#000",
    }));
  };
  addEventListener("beforeprint", forPaper);
  addEventListener("afterprint", () => drawn.forEach(draw));
})();
