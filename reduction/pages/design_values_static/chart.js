// Small figures of the quantity over one level through the chosen point.

const CHART = { width: 330, height: 220, left: 52, right: 10, top: 10, bottom: 40, steps: 60 };
const SVG = "http://www.w3.org/2000/svg";

function svg(name, attributes = {}, text = null) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== null) element.textContent = text;
  return element;
}

function evenly(low, high, count) {
  const step = (high - low) / (count - 1);
  return Array.from({ length: count }, (_, place) => (place === count - 1 ? high : low + place * step));
}

// Round numbers between two ends, about as many as asked for.
function ticksOf(low, high, count) {
  const raw = (high - low) / count, size = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((one) => one * size).find((one) => one >= raw);
  const found = [];
  for (let place = Math.ceil(low / step - 1e-9); place * step <= high + step * 1e-9; place += 1) {
    found.push(place * step + 0); // no zero with a sign
  }
  return found;
}

// Range of a level that was tested: of a damping that of the spring in it.
function rangeOfLevel(line, quantity, name, branch) {
  const surface = line.surfaces[quantity === DASHPOT ? SPRING : quantity];
  if (surface && line.factors.includes(name)) {
    const place = line.factors.indexOf(name);
    return [surface.low[place], surface.high[place]];
  }
  const curve = line.curves.find((one) => one.quantity === quantity && one.variable === name
    && (!branch || one.branch === branch));
  return curve ? [curve.low, curve.high] : [NaN, NaN];
}

function valueOrNone(line, quantity, levels, options) {
  try {
    const found = lookUp(line, quantity, levels, { ...options, flag: true });
    return found.inside ? found : null;
  } catch (error) {
    if (error instanceof Refusal) return null;
    throw error;
  }
}

// One figure: value over one level, the others as chosen; x and y in the units that are shown.
function chartOf({ line, quantity, branch, levels, name, found, x: [xUnit, xFactor], y: [yUnit, yFactor] }) {
  const [low, high] = rangeOfLevel(line, quantity, name, branch);
  if (!(high > low)) return null;
  const at = evenly(low, high, CHART.steps + 1);
  const curve = line.curves.find((one) => one.quantity === quantity && one.variable === name
    && (!branch || one.branch === branch));
  if (curve && !curve.coefficient.length) {
    // corners of straight pieces; where two meet, both
    curve.at.forEach((x) => at.push(x, x * (1 - 1e-12)));
    at.sort((a, b) => a - b);
  }
  const points = at.map((x) => [x, valueOrNone(line, quantity, { ...levels, [name]: x }, { branch })]);
  const seen = points.filter((one) => one[1]).flatMap(([, one]) => (
    [one.value, one.low, one.high, one.surface_low, one.surface_high])).filter(Number.isFinite);
  if (found && Number.isFinite(found.value)) seen.push(found.value);
  if (!seen.length) return null;
  let bottom = Math.min(...seen), top = Math.max(...seen);
  if (bottom > 0 && bottom < 0.5 * top) bottom = 0;
  const margin = 0.06 * (top - bottom || Math.abs(top) || 1);
  top += margin;
  bottom = bottom === 0 ? 0 : bottom - margin;
  const chosen = levels[name];
  const left = Math.min(low, Number.isFinite(chosen) ? chosen : low);
  const right = Math.max(high, Number.isFinite(chosen) ? chosen : high);
  const edge = 0.06 * (right - left);
  const box = CHART.width - CHART.left - CHART.right, tall = CHART.height - CHART.top - CHART.bottom;
  const toX = (x) => CHART.left + ((x - left + edge) / (right - left + 2 * edge)) * box;
  const toY = (y) => CHART.top + ((top - y) / (top - bottom)) * tall;
  const words = name.replaceAll("_", " ");
  const xShown = xUnit === "1" ? words : `${words} [${xUnit}]`;
  const root = svg("svg", {
    viewBox: `0 0 ${CHART.width} ${CHART.height}`, role: "img",
    "aria-label": `${quantity.replaceAll("_", " ")} over ${words}, tested ${short(xFactor * low)} to ${short(xFactor * high)} ${xUnit}`,
  });
  root.append(svg("rect", {
    x: CHART.left, y: CHART.top, width: box, height: tall, class: "untested",
  }), svg("rect", { x: toX(low), y: CHART.top, width: toX(high) - toX(low), height: tall, class: "tested" }));
  for (const [from, to] of curve?.gaps ?? []) {
    root.append(svg("rect", { x: toX(from), y: CHART.top, width: toX(to) - toX(from), height: tall, class: "untested" }));
  }
  const ticks = ticksOf(yFactor * bottom, yFactor * top, 4);
  const thousands = thousandsOf(Math.max(...ticks.map(Math.abs)));
  for (const tick of ticks) {
    const y = toY(tick / yFactor);
    root.append(svg("line", { x1: CHART.left, x2: CHART.left + box, y1: y, y2: y, class: "grid" }),
      svg("text", { x: CHART.left - 5, y: y + 4, class: "tick end" }, plainNumber(tick / 1000 ** thousands, 4)));
  }
  for (const tick of ticksOf(xFactor * (left - edge), xFactor * (right + edge), 5)) {
    const x = toX(tick / xFactor);
    root.append(svg("line", { x1: x, x2: x, y1: CHART.top + tall, y2: CHART.top + tall + 4, class: "axis" }),
      svg("text", { x, y: CHART.top + tall + 16, class: "tick middle" }, grouped(plainNumber(tick, 4))));
  }
  for (const part of connected(points)) {
    for (const [a, b, kind] of [["low", "high", "run"], ["surface_low", "surface_high", "surface"]]) {
      const inBand = part.filter(([, one]) => Number.isFinite(one[a]) && Number.isFinite(one[b]));
      if (inBand.length > 1) {
        const outline = [...inBand.map(([x, one]) => [x, one[b]]), ...inBand.reverse().map(([x, one]) => [x, one[a]])];
        root.append(svg("path", {
          d: `M${outline.map(([x, y]) => `${toX(x).toFixed(1)} ${toY(y).toFixed(1)}`).join("L")}Z`, class: `band ${kind}`,
        }));
      }
    }
    root.append(svg("path", {
      d: `M${part.map(([x, one]) => `${toX(x).toFixed(1)} ${toY(one.value).toFixed(1)}`).join("L")}`, class: "curve",
    }));
  }
  root.append(svg("rect", { x: CHART.left, y: CHART.top, width: box, height: tall, class: "frame" }));
  if (Number.isFinite(chosen)) {
    const x = toX(chosen);
    root.append(svg("line", { x1: x, x2: x, y1: CHART.top, y2: CHART.top + tall, class: "cross" }));
    if (found && Number.isFinite(found.value)) {
      root.append(svg("circle", { cx: x, cy: toY(found.value), r: 5, class: "point" }));
    }
  }
  root.append(
    svg("text", { x: CHART.left + box / 2, y: CHART.height - 6, class: "label middle" }, xShown),
    svg("text", {
      x: 12, y: CHART.top + tall / 2, class: "label middle", transform: `rotate(-90 12 ${CHART.top + tall / 2})`,
    }, `${symbolOf(quantity)} [${unitWithPower(yUnit, thousands)}]`));
  return root;
}

// Runs of points that have a value.
function connected(points) {
  const parts = [[]];
  for (const one of points) {
    if (one[1] && Number.isFinite(one[1].value)) parts[parts.length - 1].push(one);
    else parts.push([]);
  }
  return parts.filter((part) => part.length > 1);
}

// Power of a thousand that leaves the numbers of an axis short.
function thousandsOf(greatest) {
  if (!(greatest > 0) || (greatest < 10000 && greatest >= 0.1)) return 0;
  return Math.floor(Math.log10(greatest) / 3 + 1e-9);
}

function unitWithPower(unit, thousands) {
  if (!thousands) return unit;
  const power = String(3 * thousands).replace(/./g, (sign) => (sign === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[sign]));
  return `10${power}${unit === "1" ? "" : ` ${unit}`}`;
}

function symbolOf(quantity) {
  return DATA.symbols[quantity] ?? quantity.replaceAll("_", " ");
}
