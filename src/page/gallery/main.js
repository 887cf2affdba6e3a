// The gallery of the papers' figures: each with what was printed, what is found here, and what differs.

function said(figure) {
  const list = element("dl");
  for (const [key, name] of [["printed", "printed"], ["here", "here"], ["differs", "what differs"], ["made", "made from"]]) {
    if (figure[key]) list.append(element("dt", {textContent: name}), element("dd", {textContent: figure[key]}));
  }
  return list;
}

beginPage(data.title, data.subtitle);
data.figures.forEach((figure, i) => {
  const made = section("figure" + i, figure.title, "", figure.short);
  const sides = element("div", {className: "sides"});
  const ranges = new Map();
  const charts = figure.charts.map((chart) => {
    if (!ranges.has(chart.x_label)) ranges.set(chart.x_label, rangeOf(chart));
    return new Chart(chart.y_label, {range: ranges.get(chart.x_label), layers: layersOf(chart), log: chart.logarithmic ?? false, hasLog: mayBeLogarithmic(chart),
                                     xLabel: chart.x_label, height: chart.height ?? 190}).figure;
  });
  sides.append(element("div", {className: "stack"}, ...charts), said(figure));
  made.append(sides);
});
if (data.missing.length > 0) {
  section("missing", "Not made").append(tableOf(["figure", "why"], [0, 1], data.missing.map((row) => row.map((text) => cell(text, "text wide")))));
}
makeToolbar();
