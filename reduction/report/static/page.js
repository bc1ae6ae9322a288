"use strict";
(() => {
  const plots = [...document.querySelectorAll(".plot")];
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const drawn = new Set();
  let printing = false;
  // the two blues, lighter by one step each: the darker one fades on a dark page
  const ON_DARK = [["#56B4E9", "#B3E0FF"], ["#0072B2", "#4AA3DF"]];
  const AXIS = 52; // ticks and title under a plot, in CSS pixels
  // what an A4 or Letter page with 15 mm margins holds, in CSS pixels: one figure, or two abreast
  const PAPER = { wide: 655, narrow: 318 };

  const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  const themed = (layout, legend) => {
    const colours = printing
      ? { font: "#000", faint: "#333", grid: "#ccc", paper: "#fff" }
      : { font: ink("--ink"), faint: ink("--faint"), grid: ink("--grid"), paper: ink("--paper") };
    const result = {
      ...layout,
      autosize: true,
      paper_bgcolor: colours.paper,
      plot_bgcolor: colours.paper,
      font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: colours.font },
      margin: { l: 64, r: 16, t: layout.title.subtitle ? 62 : 44, b: AXIS + legend },
      legend: { orientation: "h", x: 0, y: 0, yref: "container", yanchor: "bottom", tracegroupgap: 0, font: { size: 11 }, ...layout.legend },
      hoverlabel: { namelength: 40 },
      hovermode: "closest",
      title: { ...layout.title, x: 0.01, xanchor: "left", y: 0.98, yanchor: "top", yref: "container", font: { size: 14 } },
    };
    if (layout.title.subtitle) {
      result.title.subtitle = { ...layout.title.subtitle, font: { size: 11, color: printing ? "#7a2b00" : ink("--bad") } };
    }
    if (layout.scene) {
      const scene = { ...layout.scene };
      for (const name of ["xaxis", "yaxis", "zaxis"]) {
        scene[name] = {
          gridcolor: colours.grid, zerolinecolor: colours.grid, color: colours.font,
          showbackground: false, exponentformat: "none", tickfont: { size: 10 }, ...layout.scene[name],
        };
        scene[name].title = { ...scene[name].title, font: { size: 11 } };
      }
      result.scene = scene;
      result.margin = { l: 0, r: 0, t: result.margin.t, b: 4 };
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
  const legendHeight = (data, width) => {
    const entries = data.filter((trace) => trace.showlegend !== false);
    const longest = Math.max(0, ...entries.map((trace) => trace.name.length));
    const columns = Math.max(1, Math.floor((width - 80) / (52 + 6.2 * longest)));
    return entries.length > 1 ? 12 + 19 * Math.ceil(entries.length / columns) : 0;
  };

  const draw = (plot) => {
    let text = document.getElementById(plot.dataset.figure).textContent;
    if (dark.matches && !printing) {
      for (const [onWhite, onDark] of ON_DARK) text = text.replaceAll(onWhite, onDark);
    }
    const { data, layout } = JSON.parse(text);
    const onPaper = plot.parentElement.classList.contains("wide") ? PAPER.wide : PAPER.narrow;
    const width = printing ? onPaper : plot.clientWidth;
    const legend = legendHeight(data, width);
    const tall = Number(plot.dataset.height) + legend;
    plot.style.minHeight = `${tall}px`;
    if (layout.scene && width < 420) {
      // from farther away, or the numbers of the axes leave the figure
      for (const axis of ["x", "y", "z"]) layout.scene.camera.eye[axis] *= 1.25;
    }
    const shown = { ...themed(layout, legend), height: tall, showlegend: legend > 0 };
    if (printing) Object.assign(shown, { width, autosize: false });
    drawn.add(plot);
    return Plotly.react(plot, data, shown, {
      responsive: true, displaylogo: false, modeBarButtonsToRemove: ["lasso2d", "select2d"],
      toImageButtonOptions: { format: "svg", filename: plot.parentElement.id },
    });
  };

  const drawAll = () => plots.filter((plot) => !drawn.has(plot)).forEach(draw);

  const near = new IntersectionObserver((seen) => {
    for (const entry of seen) {
      const plot = entry.target;
      if (entry.isIntersecting) {
        if (!drawn.has(plot)) draw(plot);
        if (!plot.layout?.scene) near.unobserve(plot);
      } else if (drawn.has(plot) && plot.layout?.scene && !printing) {
        // a browser keeps only some figures in space alive at a time: those out of sight make room
        Plotly.purge(plot);
        drawn.delete(plot);
      }
    }
  }, { rootMargin: "600px" });
  plots.forEach((plot) => near.observe(plot));

  dark.addEventListener("change", () => drawn.forEach(draw));
  document.getElementById("draw-all")?.addEventListener("click", drawAll);
  // a page whose figures come later, or change, says so
  document.addEventListener("figure", ({ target }) => {
    if (drawn.has(target)) draw(target);
    else near.observe(target);
  });

  // paper is white and narrower than the screen, whatever the screen is
  addEventListener("beforeprint", () => {
    printing = true;
    document.querySelectorAll("details:not(.provenance, .notes)").forEach((part) => { part.open = true; });
    plots.forEach(draw);
  });
  addEventListener("afterprint", () => {
    printing = false;
    drawn.forEach(draw);
  });
})();
