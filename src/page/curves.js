// Charts of curves over any quantity, as tools describe them: {heading, note, x_label, y_label, logarithmic, marks, fills, height,
// band: {low, high, label}, lines: [{x, label}], curves: [{label, x, y, crosses, candidates: {x, y}, points, colour}]}.

/** A label without marks of mathematics, and, of an axis, without explanations. */
function plain(label) {
  return label.replaceAll("$T_2$", "T2").replaceAll("$\\tau$", "τ").replace(/^(\S+), .* \[/, "$1 [");
}

/** A span that all finite x lie in, with room at both ends. */
function rangeOf(chart) {
  const all = [...chart.curves.flatMap((curve) => [...curve.x, ...(curve.crosses ?? [])]),
               ...(chart.band ? [chart.band.low, chart.band.high] : [])];
  let low = Infinity;
  let high = -Infinity;
  for (const x of all) {
    low = Math.min(low, x);
    high = Math.max(high, x);
  }
  const isFilled = chart.fills && !chart.curves.some((curve) => curve.points);  // half of a point at an end would be cut
  const room = isFilled ? 0 : 0.02 * (high - low || Math.abs(high) || 1);
  return new TimeRange(low - room, high + room);
}

/** Whether a logarithmic axis would show all of it. */
function mayBeLogarithmic(chart) {
  return chart.curves.every((curve) => curve.y.every((y) => y === null || y >= 0));
}

function layersOf(chart) {
  const layers = [];
  if (chart.band) layers.push({kind: "interval", from: chart.band.low, to: chart.band.high, label: chart.band.label, colour: "muted"});
  if (chart.lines) {
    const times = Float64Array.from(chart.lines, (line) => line.x).sort();
    layers.push({kind: "marks", times, colour: "bad", label: chart.lines[0].label});
  }
  chart.curves.forEach((curve, i) => {
    const colour = curve.colour ?? "series-" + (i % 7);
    const values = Float64Array.from(curve.y, (y) => y ?? NaN);
    const times = Float64Array.from(curve.x);
    if (curve.points) layers.push({kind: "points", times, values, colour, label: curve.label, marker: "dot"});
    else layers.push({kind: "line", series: Series.of(times, values), colour, label: curve.label});
    if (chart.marks && !curve.points) layers.push({kind: "points", times, values, colour, marker: "dot"});
    if (curve.candidates && curve.candidates.x.length > 0) {
      layers.push({kind: "points", times: Float64Array.from(curve.candidates.x), values: Float64Array.from(curve.candidates.y),
                   colour, marker: "diamond", label: `${curve.label}: beaten by another T2`});
    }
    if (curve.crosses?.length > 0) {
      layers.push({kind: "absent", times: curve.crosses, row: i, marker: "cross", colour, label: `${curve.label}: no design`});
    }
  });
  return layers;
}

/** Charts in sections by their headings; those over the same quantity move together. */
function chartSections() {
  const groups = new Map();
  const ranges = new Map();
  data.charts.forEach((chart) => {
    const heading = chart.heading ?? "Curves";
    if (!groups.has(heading)) groups.set(heading, {note: chart.note ?? "", charts: []});
    if (!ranges.has(chart.x_label)) ranges.set(chart.x_label, rangeOf(chart));
    groups.get(heading).charts.push(new Chart(plain(chart.y_label), {
      range: ranges.get(chart.x_label), layers: layersOf(chart), log: chart.logarithmic, hasLog: mayBeLogarithmic(chart),
      xLabel: plain(chart.x_label), height: chart.height ?? 380}));
  });
  let number = 0;
  for (const [heading, {note, charts}] of groups) grid(section("charts" + number++, heading, note), charts);
}

