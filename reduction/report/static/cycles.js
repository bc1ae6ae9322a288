// A cycle chosen in one figure of a test is shown in the others of the test.

const tests = new Map(); // section of a test to its cycles and the one that is chosen

for (const bar of document.querySelectorAll(".cycles")) {
  const { count, start, end, number } = JSON.parse(document.getElementById(bar.dataset.cycles).textContent);
  const numbers = number ?? start.map((_, place) => place + 1);
  const section = bar.closest("section");
  const input = bar.querySelector("input");
  const test = {
    bar, count, start, end, numbers, input, chosen: null, asked: null,
    state: bar.querySelector("[role=status]"), clear: bar.querySelector("button"),
  };
  tests.set(section, test);
  input.addEventListener("change", () => {
    const wanted = input.valueAsNumber;
    choose(section, Number.isFinite(wanted) ? wanted : null);
  });
  test.clear.addEventListener("click", () => { choose(section, null); input.focus(); });
}

const grouped = (number) => number.toLocaleString("en-US");

/** Place of the listed cycle that is nearest to a number. */
const nearest = (numbers, wanted) => numbers.reduce(
  (best, number, place) => (Math.abs(number - wanted) < Math.abs(numbers[best] - wanted) ? place : best), 0);

const choose = (section, wanted) => {
  const test = tests.get(section);
  const place = wanted === null ? null : nearest(test.numbers, wanted);
  test.chosen = place;
  const number = place === null ? null : test.numbers[place];
  test.input.value = number ?? "";
  test.clear.disabled = place === null;
  test.bar.classList.toggle("chosen", place !== null);
  if (place === null) {
    test.state.textContent = `No cycle selected (1 to ${grouped(test.count)})`;
  } else {
    const [from, to] = [test.start[place], test.end[place]];
    const when = from === null ? "" : `, from ${tidy(from)} to ${tidy(to)} s`;
    const asked = wanted === number ? "" : `; ${grouped(wanted)} cannot be chosen here`;
    test.state.textContent = `Cycle ${grouped(number)} of ${grouped(test.count)}${when}${asked}`;
  }
  for (const plot of section.querySelectorAll(".plot")) {
    if (drawn.has(plot)) drawAgain(plot);
  }
};

const tidy = (value) => (value === null ? "?" : grouped(Number(value.toPrecision(7))));

/** Choose the cycle of a point that a reader clicked. */
const chooseAt = (plot, point) => {
  const section = plot.closest("section");
  if (!tests.has(section)) return;
  const meta = plot.layout.meta;
  if (point.data.meta?.cycle) choose(section, point.data.meta.cycle);
  else if (meta?.cycles === "number") choose(section, Math.round(point.x));
};

// in a record any place is at a time, whether a point is near or not
for (const plot of plots) {
  plot.addEventListener("click", (event) => {
    const section = plot.closest("section");
    const test = tests.get(section);
    const meta = plot.layout?.meta;
    if (!test || meta?.cycles !== "time" || !event.target.closest(".draglayer")) return;
    const axis = plot._fullLayout.xaxis;
    const across = event.clientX - plot.getBoundingClientRect().left - axis._offset;
    if (across < 0 || across > axis._length) return;
    const time = axis.p2d(across) * meta.seconds;
    const place = test.start.findIndex((from, at) => from !== null && from <= time && time <= test.end[at]);
    if (place >= 0) choose(section, test.numbers[place]);
    else test.state.textContent = `No listed cycle was at ${tidy(time)} s`;
  });
}

/** Say under a figure what it lacks of the chosen cycle. */
const say = (plot, text) => {
  let line = plot.parentElement.querySelector(".lacks");
  if (!line && text) {
    line = document.createElement("p");
    line.className = "lacks";
    plot.after(line);
  }
  if (line) {
    line.textContent = text ?? "";
    line.hidden = !text;
  }
};

/** A figure with what it can show of the cycle that is chosen in its test. */
const withCycle = (plot, { data, layout }, colours) => {
  const test = tests.get(plot.closest("section"));
  const axis = layout.meta?.cycles;
  const own = [...new Set(data.map((trace) => trace.meta?.cycle).filter(Boolean))];
  if (!test || test.chosen === null || !(axis || own.length)) {
    say(plot, null);
    return { data, layout };
  }
  const number = test.numbers[test.chosen];
  const called = `cycle ${grouped(number)}`;
  if (own.length) {
    const isThere = own.includes(number);
    say(plot, isThere ? null : `${called} is not drawn here; drawn: ${own.map(grouped).join(", ")}.`.replace(/^c/, "C"));
    if (!isThere) return { data, layout };
    const lit = data.map((trace) => (trace.meta?.cycle === number
      ? { ...trace, visible: true, line: { ...trace.line, width: trace.fill ? 0 : 3 } }
      : { ...trace, opacity: 0.25, ...(trace.fill ? { fillcolor: "rgba(128,128,128,0.08)" } : {}) }));
    return { data: lit, layout };
  }
  const look = { layer: "above", xref: "x", yref: "paper", y0: 0, y1: 1, name: called };
  const shapes = [...(layout.shapes ?? [])];
  const annotations = [...(layout.annotations ?? [])];
  const isLog = layout.xaxis.type === "log";
  const label = (x) => annotations.push({
    text: called, x: isLog ? Math.log10(x) : x, xref: "x", y: 1, yref: "paper", yanchor: "bottom",
    showarrow: false, font: { size: 11, color: colours.ink },
  });
  if (axis === "time") {
    const [from, to] = [test.start[test.chosen], test.end[test.chosen]].map((time) => time && time / layout.meta.seconds);
    if (from === null || to === null) {
      say(plot, `When ${called} was is not known.`);
      return { data, layout };
    }
    // a short cycle of a long record is a line
    shapes.push({ ...look, type: "rect", x0: from, x1: to, fillcolor: "rgba(128,128,128,0.35)", line: { color: colours.ink, width: 1.5 } });
    label((from + to) / 2);
    say(plot, null);
    return { data, layout: { ...layout, shapes, annotations } };
  }
  shapes.push({ ...look, type: "line", x0: number, x1: number, line: { color: colours.ink, width: 1, dash: "dot" } });
  label(number);
  const points = [];
  for (const trace of data) {
    const place = trace.fill ? -1 : trace.x.indexOf(number);
    if (place >= 0 && trace.y[place] !== null) points.push([trace, trace.y[place]]);
  }
  say(plot, points.length ? null : `The point of ${called} is not drawn here: not the least nor the greatest of its stretch, or not known.`);
  const marked = points.map(([trace, y]) => ({
    type: "scatter", mode: "markers", x: [number], y: [y], name: `${trace.name}, ${called}`, showlegend: false,
    marker: { symbol: "circle-open", size: 13, color: colours.ink, line: { width: 2.5 } },
  }));
  return { data: [...data, ...marked], layout: { ...layout, shapes, annotations } };
};
