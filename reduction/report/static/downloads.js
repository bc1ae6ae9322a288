// What a figure draws as CSV, and the figure as SVG and PNG, made in the page: nothing is fetched.

const SIZES = { wide: 1000, narrow: 640 }; // width of a picture, in CSS pixels
const MOST_LETTERS = 60; // of each part of a file name

const slug = (text) => {
  const tidied = text.normalize("NFC").replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^[-.]+|[-.]+$/g, "");
  return [...tidied].slice(0, MOST_LETTERS).join("");
};

/** Campaign, test and figure, as the name of a file. */
const fileName = (plot, ending) => {
  const section = plot.closest("section");
  const prefix = section.dataset.key ? `${section.dataset.key}-` : "";
  const key = plot.parentElement.id;
  const own = prefix && key.startsWith(prefix) ? key.slice(prefix.length) : key;
  const parts = [document.body.dataset.campaign, section.dataset.title ?? "", own];
  return `${parts.map(slug).filter(Boolean).join("_")}.${ending}`;
};

const cell = (value) => {
  if (value === null || value === undefined) return "";
  if (typeof value === "number") return String(Number(value.toPrecision(9)));
  const text = plain(value).replace(/\s+/g, " ");
  // a program for tables would take such text for a formula
  const safe = /^[=+\-@]/.test(text) ? `'${text}` : text;
  return /[",]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
};

const axisOf = (layout, trace, letter) => {
  if (layout.scene) return layout.scene[`${letter}axis`];
  return layout[`${letter}axis${(trace[`${letter}axis`] ?? letter).slice(1)}`] ?? {};
};

/** What a value on an axis of names is called. */
const named = (axis, value) => {
  const place = axis.ticktext && axis.tickvals ? axis.tickvals.indexOf(value) : -1;
  return place >= 0 ? plain(axis.ticktext[place]) : value;
};

// a band is drawn along its upper edge and back along its lower one
const edges = ({ x, y }) => {
  const runs = [];
  let first = 0;
  for (let place = 0; place <= x.length; place += 1) {
    if (place === x.length || x[place] === null) {
      if (place > first) runs.push([first, place]);
      first = place + 1;
    }
  }
  const isBand = runs.every(([from, to]) => x.slice(from, to).every((value, at) => value === x[to - 1 - at]));
  if (!isBand || !runs.length) return null;
  const half = ([from, to]) => from + (to - from) / 2;
  return {
    "upper edge": runs.flatMap((run) => x.slice(run[0], half(run)).map((value, at) => [value, y[run[0] + at]])),
    "lower edge": runs.flatMap((run) => x.slice(run[0], half(run)).map((value, at) => [value, y[run[1] - 1 - at]])),
  };
};

/** Every point that a figure draws, as rows under headings with units. */
const tableOf = ({ data, layout }) => {
  const columns = ["line"];
  const rows = [];
  const heading = (axis, letter) => plain(axis.title?.text || letter);
  const add = (line, values) => {
    for (const name of Object.keys(values)) if (!columns.includes(name)) columns.push(name);
    rows.push({ line, ...values });
  };
  for (const trace of data) {
    const [xaxis, yaxis] = ["x", "y"].map((letter) => axisOf(layout, trace, letter));
    const [across, up] = [heading(xaxis, "x"), heading(yaxis, "y")];
    const upward = up === across ? `${up}, upward` : up;
    const line = plain(trace.name ?? trace.type);
    if (Array.isArray(trace.z?.[0])) {
      const bar = trace.colorbar?.title?.text ?? "";
      const flat = bar ? `${plain(layout.title.text)} [${plain(bar)}]` : `${line} [1]`;
      const depth = layout.scene ? heading(layout.scene.zaxis, "z") : flat;
      const at = (grid, row, column) => (Array.isArray(grid[0]) ? grid[row][column] : null);
      trace.z.forEach((values, row) => values.forEach((value, column) => add(line, {
        [across]: at(trace.x, row, column) ?? trace.x[column],
        [upward]: at(trace.y, row, column) ?? trace.y[row], [depth]: value,
      })));
      continue;
    }
    const band = trace.fill === "toself" ? edges(trace) : null;
    if (band) {
      for (const [edge, points] of Object.entries(band)) {
        points.forEach(([x, y]) => add(`${line}, ${edge}`, { [across]: x, [upward]: y }));
      }
      continue;
    }
    const length = Math.max(trace.x?.length ?? 0, trace.y?.length ?? 0);
    const what = trace.hovertemplate?.match(/([\w ]+) %\{customdata/)?.[1].trim();
    const more = what && `${what} ${upward.match(/\[[^\]]*\]$/)?.[0] ?? ""}`.trim();
    for (let place = 0; place < length; place += 1) {
      const values = {
        [across]: named(xaxis, trace.x?.[place] ?? null), [upward]: named(yaxis, trace.y?.[place] ?? null),
      };
      if (trace.z) values[heading(layout.scene.zaxis, "z")] = trace.z[place];
      for (const [error, axis] of [[trace.error_x, across], [trace.error_y, upward]]) {
        if (!error?.array) continue;
        values[`${axis}, bar above`] = error.array[place];
        values[`${axis}, bar below`] = (error.arrayminus ?? error.array)[place];
      }
      if (Array.isArray(trace.base)) values[`${trace.orientation === "h" ? across : upward}, bar begins`] = trace.base[place];
      if (more) values[more] = trace.customdata[place];
      if (Array.isArray(trace.text) && trace.text[place]) values.text = plain(trace.text[place]);
      add(line, values);
    }
  }
  for (const shape of layout.shapes ?? []) {
    const [across, up] = ["x", "y"].map((letter) => {
      const at = shape[`${letter}ref`] ?? letter;
      return at.startsWith("paper") || at.endsWith("domain") ? null : heading(axisOf(layout, { [`${letter}axis`]: at }, letter), letter);
    });
    for (const end of [0, 1]) {
      add(`${shape.type === "line" ? "mark" : "shading"}${shape.name ? `: ${shape.name}` : ""}`, {
        ...(across ? { [across]: shape[`x${end}`] } : {}), ...(up ? { [up]: shape[`y${end}`] } : {}),
      });
    }
  }
  return [columns, ...rows.map((row) => columns.map((name) => row[name]))];
};

const csvOf = (plot) => {
  const figure = withCycle(plot, readFigure(plot), ON_PAPER);
  const about = [plot.parentElement.dataset.synthetic, plain(figure.layout.title.text), document.title];
  const first = cell(`# ${about.filter(Boolean).join(". ")}`);
  // the mark in front tells a program for tables that the letters are UTF-8
  return `\uFEFF${[first, ...tableOf(figure).map((row) => row.map(cell).join(","))].join("\r\n")}\r\n`;
};

/** A figure as it stands on the screen, but on white and of a set width. */
const pictureOf = async (plot, format) => {
  readProgram();
  const width = isWide(plot) ? SIZES.wide : SIZES.narrow;
  const { data, layout } = figureOf(plot, width, ON_PAPER);
  if (drawn.has(plot)) {
    data.forEach((trace, place) => { trace.visible = plot.data[place]?.visible ?? trace.visible; });
    for (const name of Object.keys(layout).filter((one) => /^[xy]axis/.test(one))) {
      if (plot.layout[name]?.autorange === false) layout[name].range = [...plot.layout[name].range];
    }
    if (layout.scene && plot.layout.scene?.camera) layout.scene.camera = plot.layout.scene.camera;
  }
  layout.font.family = "Arial, Helvetica, sans-serif";
  const address = await Plotly.toImage({ data, layout: { ...layout, width } }, { format, width, height: layout.height, scale: format === "png" ? 2 : 1 });
  const content = address.slice(address.indexOf(",") + 1);
  if (format === "svg") return new Blob([decodeURIComponent(content)], { type: "image/svg+xml" });
  return new Blob([Uint8Array.from(atob(content), (letter) => letter.charCodeAt(0))], { type: "image/png" });
};

const save = (blob, name) => {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
};

const KINDS = {
  csv: ["CSV", "data of"], svg: ["SVG", "drawing of"], png: ["PNG", "picture of"],
};
for (const plot of plots) {
  const row = document.createElement("p");
  row.className = "save";
  row.append("Save ");
  for (const [ending, [word, what]] of Object.entries(KINDS)) {
    const button = document.createElement("button");
    button.type = "button";
    // what is drawn in space is drawn as a picture
    const isPicture = ending === "svg" && "space" in plot.dataset;
    button.textContent = word;
    button.setAttribute("aria-label", `${word}: ${isPicture ? "picture inside a drawing of" : what} ${plot.parentElement.dataset.title}`);
    button.addEventListener("click", async () => {
      try {
        const blob = ending === "csv" ? new Blob([csvOf(plot)], { type: "text/csv" }) : await pictureOf(plot, ending);
        save(blob, fileName(plot, ending));
      } catch (error) {
        row.append(` ${word} could not be made: ${error.message}.`);
        throw error;
      }
    });
    row.append(button, ...(isPicture ? ["(holds a picture) "] : []));
  }
  plot.parentElement.append(row);
}
