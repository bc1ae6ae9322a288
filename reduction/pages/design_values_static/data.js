// The lines of the page, their numbers as numbers.

const DATA = JSON.parse(document.getElementById("data").textContent);

// Fields of a line whose numbers may be none or infinite.
function lineOf(line, key, group) {
  const numbers = ["diameter", "rated_break_strength", "tensile_strength", "linear_density", "wet_linear_density"];
  const decoded = (one, texts) => Object.fromEntries(Object.entries(one)
    .map(([name, value]) => [name, texts.includes(name) ? value : numbersOf(value)]));
  const ofSurface = ["quantity", "errata", "notes", "frequency_column"];
  const ofCurve = ["quantity", "variable", "branch", "spread_of", "range_note", "errata", "notes", "warnings", "is_inverse_slope"];
  const components = (one) => ({
    ...one, component: one.component.map(([source, of, number, freedom]) => [source, of, number, numbersOf(freedom)]),
  });
  const curveFrom = (one) => components({ ...decoded(one, [...ofCurve, "component"]), component: one.component });
  return {
    ...line, key, group,
    ...Object.fromEntries(numbers.map((name) => [name, numbersOf(line[name])])),
    surfaces: Object.fromEntries(Object.entries(line.surfaces).map(([name, one]) => (
      [name, components({ ...decoded(one, [...ofSurface, "component"]), component: one.component })]))),
    curves: line.curves.map(curveFrom),
    slow_pulls: Object.fromEntries(Object.entries(line.slow_pulls).map(([of, one]) => [of, curveFrom(one)])),
    is_synthetic: line.notes.includes("synthetic data"),
  };
}

const LINES = [
  ...DATA.published.map((line) => lineOf(line, line.name, "published")),
  ...DATA.campaigns.flatMap((campaign) => {
    const raw = Object.entries(campaign.files).flatMap(([test, one]) => one.lines.map((line) => [test, line]));
    return raw.map(([test, line], place) => lineOf(
      { ...line, name: campaign.names[place], specimen: line.name, test, campaign: campaign.name },
      `${campaign.name}/${campaign.names[place]}`, campaign.name));
  }),
];
