// The path of a body, or two states against each other, and the run over hybrid time (t, j).

function pathSection() {
  const axes = (data.position ?? []).map((place) => (place === null ? null : run.columns[place]));
  const present = axes.filter((column) => column !== null);
  if (present.length < 2) return;
  const curvesOf = (columns) => {
    const curves = [];
    if (columns.every((column) => column.truth)) {
      curves.push({label: "truth", colour: "truth", width: 3, axes: columns.map((column) => column.truth)});
    }
    curves.push({label: "estimate", colour: "estimate", width: 1.5, axes: columns.map((column) => column.estimate)});
    return curves;
  };
  const names = present.map((column) => withUnit(column.name, column.unit));
  const made = section("path", "Path", "In the span of time that the charts above show.");
  const charts = [new Plane("From above", {range: run.range, curves: curvesOf(present.slice(0, 2)), names})];
  if (present.length === 3) {
    const curves = curvesOf(present).map((curve) => ({...curve, points: (range) => pointsOf(curve, range)}));
    charts.push(new Space("In space (drag to turn)", {range: run.range, curves, names, isEqual: true}));
  }
  grid(made, charts);
}

/** The number of jumps at a time, of those that the truth is known to have made. */
function jumpsUpTo(time) {
  return countBelow(run.jumps, time + 1e-9);
}

/** Points (t, j, x), a gap at each jump. */
function hybridPoints(series, range) {
  const [from, to] = range.shown;
  const [begin, end] = series.indices(from, to);
  const step = Math.max(1, Math.ceil((end - begin) / MOST_POINTS));
  const points = [];
  let last = null;
  for (let i = begin; i < end; i += step) {
    const time = series.times[i];
    const jumps = jumpsUpTo(time);
    if (last !== null && jumps !== last) points.push(null);
    last = jumps;
    points.push([time, jumps, middleAt(series, i)]);
  }
  return points;
}

function hybridSection() {
  if (run.jumps.length === 0) return;
  const made = section("hybrid", "Hybrid time", "The run over (t, j): the time and the number of jumps up to it.");
  const values = Array.from(run.jumps, (_, i) => i + 1);
  const stairs = {kind: "stairs", times: [run.range.whole[0], ...run.jumps], values: [0, ...values], colour: "jump",
                  label: "jumps used"};
  const layers = [...modesLayer(), stairs];
  if (run.changes.jumps.length > 0) {
    layers.push({kind: "stairs", times: run.changes.times, values: run.changes.jumps, colour: "estimate",
                 label: "of the published estimate"});
  }
  let column = run.columns[0];
  const curves = [];
  if (run.columns.some((each) => each.truth)) {
    curves.push({label: "truth", colour: "truth", width: 3,
                 points: (range) => (column.truth ? hybridPoints(column.truth, range) : [])});
  }
  curves.push({label: "estimate", colour: "estimate", width: 1.5,
               points: (range) => hybridPoints(column.estimate, range)});
  const space = new Space("(t, j, x), drag to turn", {range: run.range, curves, names: ["t [s]", "j", withUnit(column.name, column.unit)]});
  const choice = element("select", {ariaLabel: "state"},
                         ...run.columns.map((each, i) => element("option", {value: String(i), textContent: each.name})));
  choice.addEventListener("change", () => {
    column = run.columns[Number(choice.value)];
    space.names[2] = withUnit(column.name, column.unit);
    drawSoon(space);
  });
  space.tools.append(choice);
  grid(made, [new Chart("Jumps j", {range: run.range, layers, isWhole: true, height: 460}), space]);
}
