// Figures are JSON beside their captions, deflated.  One is drawn when a reader comes near it, and again
// when the colours of the screen, its width on paper or the chosen cycle change.

const plots = [...document.querySelectorAll(".plot")];
const dark = matchMedia("(prefers-color-scheme: dark)");
const drawn = new Set();
const drawing = new WeakMap(); // the promise of what was drawn last
const stale = new Set(); // drawn, but not as they ought to look now
const inSight = new Set();
let printing = false;
// the two blues, lighter by one step each, and the grey: the darker ones fade on a dark page
const ON_DARK = [["#56B4E9", "#B3E0FF"], ["#0072B2", "#4AA3DF"], ["#686868", "#C4C4C4"]];
const AXIS = 52; // ticks and title under a plot, in CSS pixels
const TITLE = 14; // letters of a title
const SMALL = 11; // of a legend
const KEY = 40; // of an entry of it, beside its words
const GAP = 5; // between two
const MARGIN = { left: 64, right: 16 }; // of a plot
const LINE = 18; // a line of one
const RAISED = 10; // by which plotly draws a title of several lines too high
// what an A4 or Letter page with 15 mm margins holds, in CSS pixels: one figure, or two abreast
const PAPER = { wide: 655, narrow: 318 };
const FLATTER = 0.72; // of its height on the screen a figure has on paper, where two rows go on a page
const SMALL_PRINT = 10; // letters of a table on paper, in CSS pixels
const ON_PAPER = { ink: "#000", faint: "#333", grid: "#ccc", paper: "#fff", bad: "#7a2b00" };

const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
const onScreen = () => Object.fromEntries(Object.keys(ON_PAPER).map((name) => [name, ink(name)]));

// the program that draws is four megabytes: the page is there before it is read
const readProgram = () => {
  if (window.Plotly) return;
  const program = document.createElement("script");
  program.textContent = document.getElementById("plotly").textContent;
  document.head.append(program);
};

const isWide = (plot) => plot.parentElement.classList.contains("wide");
const plain = (text) => {
  const unbroken = String(text).replaceAll("<br>", " ");
  return unbroken.replaceAll("&lt;", "<").replaceAll("&gt;", ">").replaceAll("&amp;", "&");
};
const readFigure = (plot, isDark = false) => {
  const held = document.getElementById(plot.dataset.figure);
  let text = held.dataset.size ? unpack(held) : held.textContent;
  if (isDark) for (const [onWhite, onDark] of ON_DARK) text = text.replaceAll(onWhite, onDark);
  return JSON.parse(text);
};

// plotly cuts a title that is longer than its figure
const ruler = document.createElement("canvas").getContext("2d");
const brokenTitle = (text, width) => {
  ruler.font = `${TITLE}px ${getComputedStyle(document.body).fontFamily}`;
  const fits = (line) => ruler.measureText(plain(line)).width <= width - 24;
  const lines = [""];
  for (const word of text.split(" ")) {
    const last = lines.at(-1);
    if (last && fits(`${last} ${word}`)) {
      lines[lines.length - 1] = `${last} ${word}`;
      continue;
    }
    if (last) lines.push("");
    // a word that is longer than a line is broken where it has to be
    for (const letter of word.match(/&\w+;|./gu) ?? []) {
      if (lines.at(-1) && !fits(lines.at(-1) + letter)) lines.push("");
      lines[lines.length - 1] += letter;
    }
  }
  return lines;
};

const extraOf = (title) => (title.length > 1 ? (title.length - 1) * LINE + RAISED : 0);

const themed = (layout, title, { legend, height, colours }) => {
  const more = extraOf(title);
  const above = more + (layout.title.subtitle ? 62 : 44);
  const result = {
    ...layout,
    autosize: true,
    uirevision: "kept", // what a reader zoomed or switched off stays when a cycle is chosen
    paper_bgcolor: colours.paper,
    plot_bgcolor: colours.paper,
    font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: colours.ink },
    margin: { l: MARGIN.left, r: MARGIN.right, t: above, b: AXIS + legend },
    legend: { orientation: "h", x: 0, y: 0, yref: "container", yanchor: "bottom", tracegroupgap: 0, font: { size: SMALL }, ...layout.legend },
    hoverlabel: { namelength: 40 },
    hovermode: "closest",
    title: { ...layout.title, text: title.join("<br>"), x: 0.01, xanchor: "left", y: 1 - (8 + (more && RAISED)) / height, yanchor: "top", yref: "container", font: { size: TITLE } },
  };
  if (layout.title.subtitle) {
    result.title.subtitle = { ...layout.title.subtitle, font: { size: 11, color: colours.bad } };
  }
  if (layout.scene) {
    const scene = { ...layout.scene };
    for (const name of ["xaxis", "yaxis", "zaxis"]) {
      scene[name] = {
        gridcolor: colours.grid, zerolinecolor: colours.grid, color: colours.ink,
        showbackground: false, exponentformat: "none", tickfont: { size: 10 }, ...layout.scene[name],
      };
      scene[name].title = { ...scene[name].title, font: { size: 11 } };
    }
    result.scene = scene;
    result.margin = { l: 0, r: 0, t: above, b: 4 };
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

const widthOf = (text) => ruler.measureText(plain(text)).width;

// room beside the axes: numbers of many digits, a column of names, or a second axis take it from the plot
const sidesOf = (data, layout) => {
  const labels = (layout.yaxis?.ticktext ?? data.flatMap((trace) => trace.y ?? [])).filter((one) => typeof one === "string");
  const longest = Math.max(0, ...labels.flatMap((one) => one.split("<br>")).map(widthOf));
  return Math.max(MARGIN.left + 12, 34 + longest) + (layout.yaxis2?.side === "right" ? MARGIN.left : MARGIN.right);
};

// a legend under the axes takes its height from the plot unless the figure grows with it; rows as plotly fills them
const legendHeight = (data, layout, width) => {
  const entries = data.filter((trace) => trace.showlegend !== false);
  if (entries.length < 2) return 0;
  ruler.font = `${SMALL}px ${getComputedStyle(document.body).fontFamily}`;
  const room = width - sidesOf(data, layout);
  const isGrouped = (layout.legend?.traceorder ?? "grouped").includes("grouped") && entries.some((one) => one.legendgroup);
  const groups = new Map();
  entries.forEach(({ legendgroup, name }, place) => {
    const key = isGrouped && legendgroup ? legendgroup : place;
    groups.set(key, [...groups.get(key) ?? [], KEY + widthOf(name)]);
  });
  // those of a group stand one below the other; without groups all are in one row, or in columns of one width
  const blocks = [...groups.values()].map((own) => [GAP + Math.max(...own), own.length]);
  const isOneRow = blocks.reduce((sum, [own]) => sum + own, -GAP) < room;
  const column = isGrouped || isOneRow ? 0 : Math.max(...blocks.map(([own]) => own));
  let [rows, tallest, used] = [0, 0, 0];
  for (const [own, count] of blocks) {
    const needed = Math.max(own, column);
    if (used && used + needed - (isGrouped ? 0 : GAP) >= room) {
      rows += tallest;
      [tallest, used] = [0, 0];
    }
    used += needed;
    tallest = Math.max(tallest, count);
  }
  return 12 + 19 * (rows + tallest);
};

/** A figure as it is drawn so wide in these colours, with what is shown of the chosen cycle. */
const figureOf = (plot, width, colours, isDark = false) => {
  const { data, layout } = withCycle(plot, readFigure(plot, isDark), colours);
  const legend = legendHeight(data, layout, width);
  if (layout.scene && width < 420) {
    // from farther away, or the numbers of the axes leave the figure
    for (const axis of ["x", "y", "z"]) layout.scene.camera.eye[axis] *= 1.25;
  }
  const title = brokenTitle(layout.title.text, width);
  // what is written into a figure needs its room on paper, too
  const isDense = layout.yaxis?.ticktext || data.some((trace) => trace.mode?.includes("text"));
  const own = Number(plot.dataset.height) * (printing && !isDense ? FLATTER : 1);
  const height = Math.round(own + legend + extraOf(title));
  const shown = themed(layout, title, { legend, height, colours });
  return { data, layout: { ...shown, height, showlegend: legend > 0 } };
};

const draw = (plot) => {
  stale.delete(plot);
  if (!printing && !plot.clientWidth) {
    if (drawn.has(plot)) forget(plot); // folded away since
    return;
  }
  readProgram();
  const isDark = dark.matches && !printing;
  const onPaper = isWide(plot) ? PAPER.wide : PAPER.narrow;
  const width = printing ? onPaper : plot.clientWidth;
  const { data, layout } = figureOf(plot, width, printing ? ON_PAPER : onScreen(), isDark);
  plot.style.minHeight = `${layout.height}px`;
  if (printing) Object.assign(layout, { width, autosize: false });
  drawing.set(plot, Plotly.react(plot, data, layout, {
    responsive: true, displaylogo: false, modeBarButtonsToRemove: ["toImage", "lasso2d", "select2d"],
    showSendToCloud: false, plotlyServerURL: "", // plotly has a button that sends a figure to its maker
  }));
  drawn.add(plot);
  plot.removeAllListeners("plotly_click");
  plot.on("plotly_click", (clicked) => chooseAt(plot, clicked.points[0]));
};

// plotly goes on drawing after it has answered, and fails where the figure is gone by then
const forget = (plot) => {
  drawn.delete(plot);
  drawing.get(plot).then(() => drawn.has(plot) || Plotly.purge(plot));
};

const near = new IntersectionObserver((seen) => {
  for (const { target: plot, isIntersecting } of seen) {
    if (isIntersecting) {
      inSight.add(plot);
      if ((!drawn.has(plot) || stale.has(plot)) && !printing) draw(plot);
    } else {
      inSight.delete(plot);
      // a browser keeps only some figures in space alive at a time: those out of sight make room
      if (drawn.has(plot) && plot.layout?.scene && !printing) forget(plot);
    }
  }
}, { rootMargin: "600px" });
plots.forEach((plot) => near.observe(plot));

// what is out of sight waits until a reader comes back to it
const drawAgain = (plot) => {
  if (inSight.has(plot)) draw(plot);
  else stale.add(plot);
};
dark.addEventListener("change", () => drawn.forEach(drawAgain));

// a table that is too wide for the paper is set smaller, not cut off
const fitTables = () => {
  const tables = [...document.querySelectorAll(".table table")];
  document.documentElement.classList.add("measuring");
  const widths = tables.map((table) => table.offsetWidth / Number.parseFloat(getComputedStyle(table).fontSize));
  document.documentElement.classList.remove("measuring");
  tables.forEach((table, place) => {
    const size = Math.min(SMALL_PRINT, (0.97 * PAPER.wide) / widths[place]);
    table.style.setProperty("--on-paper", `${size.toFixed(2)}px`);
  });
};

// paper is white and narrower than the screen, whatever the screen is
addEventListener("beforeprint", () => {
  printing = true;
  openForPaper();
  fitTables();
  plots.forEach(draw);
});
addEventListener("afterprint", () => {
  printing = false;
  foldAgain();
  [...drawn].forEach((plot) => (inSight.has(plot) ? draw(plot) : forget(plot)));
});

addEventListener("load", () => setTimeout(readProgram, 300));
