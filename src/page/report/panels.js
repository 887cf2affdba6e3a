// Which charts there are. Each function appends its section, where there is anything to show.

const run = {};  // what sections share: see prepareRun()

function prepareRun() {
  run.estimateTimes = unpackTimes(data.estimate_times);
  run.comparedTimes = data.compared_times ? unpackTimes(data.compared_times) : new Float64Array();
  run.jumps = unpackTimes(data.jumps);
  run.changes = {times: unpackTimes(data.changes.times), jumps: unpack(data.changes.jumps),
                 modes: data.changes.modes.map((mode) => "mode " + mode)};
  run.events = unpackEvents(data.events);
  run.sampleTimes = Float64Array.from(data.sensors.flatMap((sensor) => Array.from(unpackTimes(sensor.sample_times)))).sort();
  const ends = [run.estimateTimes, run.comparedTimes, run.events.arrival].filter((times) => times.length > 0);
  run.range = new TimeRange(Math.min(...ends.map((times) => times[0])),
                            Math.max(...ends.map((times) => times[times.length - 1])));
  run.columns = data.columns.map((column) => {
    const made = {name: column.name, angular: column.angular, unit: column.unit, exceeded: column.exceeded};
    for (const key of ["estimate", "bound", "deviation"]) {
      if (column[key]) made[key] = new Series(run.estimateTimes, column[key]);
    }
    for (const key of ["truth", "error", "error_bound", "hold_error"]) {
      if (column[key]) made[key] = new Series(run.comparedTimes, column[key]);
    }
    return made;
  });
}

/** An array of each property of events, as the page unpacks it once. */
function unpackEvents(packed) {
  const events = {...packed, arrival: unpackTimes(packed.arrival)};
  for (const key of ["latency", "source", "kind", "outcome", "reason", "interval", "check", "rewound", "innovation", "nis"]) {
    events[key] = unpack(packed[key]);
  }
  return events;
}

const OUTCOME = {used: 0, usedLate: 1, gated: 11};
const KIND = {input: 0, jump: 1, jumpOutput: 2, output: 4, sample: 5, withdrawal: 7};

/** A name with its unit, where it has one. */
function withUnit(name, unit) {
  return unit ? `${name} [${unit}]` : name;
}

/** The unit of a norm over all that is compared; empty where they have none in common. */
function unitOfNorm() {
  const units = new Set(run.columns.filter((column) => column.error).map((column) => column.unit));
  return units.size === 1 ? [...units][0] : "";
}

function modesLayer() {
  const {times, modes} = run.changes;
  if (modes.length === 0) return [];
  return [{kind: "spans", times, labels: modes, order: [...new Set(modes)].sort()}];
}

function jumpsLayer() {
  return run.jumps.length > 0 ? [{kind: "marks", times: run.jumps, colour: "jump", label: "jumps"}] : [];
}

/** Points in the order of their times, those of some outcomes only. */
function pointsLayer(times, values, indices, properties) {
  const order = indices.sort((a, b) => times[a] - times[b]);
  return {kind: "points", times: Float64Array.from(order, (i) => times[i]),
          values: Float64Array.from(order, (i) => values[i]), ...properties};
}

function samplesLayers(place) {
  const own = data.samples.filter((samples) => samples.column === place);
  if (own.length === 0) {
    if (run.sampleTimes.length === 0) return [];
    return [{kind: "marks", atBottom: true, times: run.sampleTimes, colour: "used", label: "times of samples"}];
  }
  const times = [];
  const values = [];
  const groups = {used: [], late: [], gated: [], rejected: []};
  for (const samples of own) {
    const at = unpackTimes(samples.times);
    const value = unpackValues(samples.values);
    unpack(samples.outcomes).forEach((outcome, i) => {
      const group = {[OUTCOME.used]: "used", [OUTCOME.usedLate]: "late", [OUTCOME.gated]: "gated"}[outcome];
      groups[group ?? "rejected"].push(times.length);
      times.push(at[i]);
      values.push(value[i]);
    });
  }
  const styles = {
    used: {label: "samples used", colour: "used", marker: "dot"},
    late: {label: "used late", colour: "late", marker: "diamond"},
    gated: {label: "gated", colour: "gated", marker: "cross"},
    rejected: {label: "rejected", colour: "rejected", marker: "cross"},
  };
  return Object.keys(groups).filter((group) => groups[group].length > 0)
    .map((group) => pointsLayer(times, values, groups[group], styles[group]));
}

function stateChart(column, place) {
  const breaks = run.jumps;
  const {angular} = column;
  const layers = [...modesLayer(), ...jumpsLayer()];
  if (column.bound) {
    layers.push({kind: "band", centre: column.estimate, width: column.bound, colour: "estimate", breaks, angular,
                 label: "guaranteed bound"});
  }
  if (column.deviation) {
    layers.push({kind: "band", centre: column.estimate, width: column.deviation, factor: 3, colour: "deviation",
                 breaks, angular, label: "3σ"});
  }
  if (column.truth) {
    layers.push({kind: "line", series: column.truth, colour: "truth", width: 2.6, breaks, angular, label: "truth"});
  }
  // What was not used lies above the curves.
  const samples = samplesLayers(place);
  layers.push(...samples.filter((layer) => layer.marker !== "cross"),
              {kind: "line", series: column.estimate, colour: "estimate", breaks, angular, label: "estimate"},
              ...samples.filter((layer) => layer.marker === "cross"));
  return new Chart(withUnit(column.name, column.unit), {range: run.range, layers});
}

function errorChart(column) {
  const layers = [...modesLayer(), ...jumpsLayer()];
  if (column.bound) {
    layers.push({kind: "band", width: column.error_bound, colour: "estimate", label: "guaranteed bound"});
  }
  if (column.deviation) {
    layers.push({kind: "band", width: column.deviation, factor: 3, colour: "deviation", label: "3σ"});
  }
  if (column.hold_error.limits(0, column.hold_error.times.length)[0] < Infinity) {
    layers.push({kind: "line", series: column.hold_error, colour: "hold", width: 1, isHidden: true,
                 label: "of the last sample held"});
  }
  layers.push({kind: "line", series: column.error, colour: "error", breaks: run.jumps, label: "error x̂ − x"});
  const exceeded = {times: unpackTimes(column.exceeded.times), values: unpackValues(column.exceeded.values)};
  if (exceeded.times.length > 0) {
    layers.push({kind: "points", ...exceeded, marker: "cross", colour: "bad", label: "beyond its bound"});
  }
  return new Chart("Error of " + withUnit(column.name, column.unit), {range: run.range, layers});
}

function statesSection() {
  const notes = ["Drag to zoom, Shift and drag to move, Ctrl and wheel to zoom at the pointer, double-click for the whole run; "
    + "all axes of time move together. Names in a chart's heading switch what it shows on and off."];
  if (data.stride > 1) {
    notes.push(`Each entry is the least and the largest of ${data.stride} values, since the run is long.`);
  }
  if (data.counted) {
    notes.push(`The verdict counts stamps from ${shortNumber(data.counted[0])} s to ${shortNumber(data.counted[1])} s.`);
  }
  const made = section("states", "States", notes.join(" "));
  const hasErrors = run.columns.some((column) => column.error);
  const charts = [];
  run.columns.forEach((column, place) => {
    charts.push(stateChart(column, place));
    if (column.error) charts.push(errorChart(column));
    else if (hasErrors) charts.push(null);
  });
  if (charts.includes(null)) {
    // A state that is not compared has the row to itself.
    charts.forEach((chart, i) => { if (chart === null) charts[i - 1].figure.style.gridColumn = "1 / -1"; });
  }
  grid(made, charts.filter((chart) => chart !== null), run.columns.length === 1 && !hasErrors);
}

function normSection() {
  if (!data.norm) return;
  const norm = new Series(run.comparedTimes, data.norm);
  const bound = new Series(run.comparedTimes, data.norm_bound);
  const layers = [...modesLayer(), ...jumpsLayer()];
  const [, largest] = bound.limits(0, bound.times.length);
  if (largest > -Infinity) {
    layers.push({kind: "line", series: bound, colour: "hold", width: 1.8, label: "guaranteed bound"});
  }
  layers.push({kind: "line", series: norm, colour: "error", breaks: run.jumps, label: "norm of the error"});
  data.beside.forEach((other, i) => {
    layers.push({kind: "line", series: new Series(unpackTimes(other.times), other.norm), width: 1.1,
                 colour: "series-" + ((i + 1) % 5), label: "with " + other.name});
  });
  const made = section("norm", "Norm of the error", "", "Norm");
  grid(made, [new Chart(withUnit("Norm of the error", unitOfNorm()), {range: run.range, layers, log: true, hasLog: true, height: 260})]);
}

/** The norm of the errors over all seeds of a thinning, and figures of each. */
function seedsSection() {
  if (!data.seeds) return;
  const times = unpackTimes(data.seeds.times);
  const layers = [...modesLayer(), ...jumpsLayer(),
                  {kind: "line", series: new Series(times, data.seeds.range), colour: "truth", label: "least to largest of all seeds"},
                  {kind: "line", series: new Series(times, data.seeds.median), colour: "error", width: 1.8, label: "median"}];
  const made = section("seeds", "Seeds", "The norm of the error at the stamps that all seeds compared.");
  grid(made, [new Chart(withUnit("Norm of the error over seeds", unitOfNorm()), {range: run.range, layers, log: true, hasLog: true, height: 260})]);
  const share = (row) => (row.share === null ? "–" : shortNumber(100 * row.share, 3) + " %");
  made.append(element("details", {}, element("summary", {textContent: "each seed"}),
    tableOf(["seed", "RMSE (norm)", "largest", "largest share of the bound"], [], data.seeds.rows.map((row) => [
      cell(row.seed), cell(shortNumber(row.rmse)), cell(shortNumber(row.largest)), cell(share(row), row.is_guarantee_broken ? "bad" : "")]))));
}

/** The Lyapunov function of the certificate along the error, and the bound on it. */
function lyapunovSection() {
  if (!data.lyapunov_bound) return;
  const bound = new Series(run.estimateTimes, data.lyapunov_bound);
  if (bound.limits(0, bound.times.length)[1] === -Infinity) return;
  const layers = [...modesLayer(), ...jumpsLayer(),
                  {kind: "line", series: bound, colour: "hold", width: 1.8, label: "W"}];
  if (data.lyapunov) {
    layers.push({kind: "line", series: new Series(run.comparedTimes, data.lyapunov), colour: "error",
                 label: "V(x − x̂)"});
  }
  const made = section("lyapunov", "Lyapunov function", "The certificate proves V(x − x̂) ≤ W: the error lies in an "
    + "ellipsoid. V and W are scaled so that W is the mean square of its semi-axes.", "Lyapunov");
  grid(made, [new Chart("V along the error, and W", {range: run.range, layers, log: true, hasLog: true, height: 260})]);
}

function innovationsSection() {
  const {innovation, nis, source, outcome, arrival, latency} = run.events;
  const times = arrival.map((time, i) => time - latency[i]);
  const charts = data.events.sources.flatMap((name, place) => {
    const used = [];
    const notUsed = [];
    innovation.forEach((value, i) => {
      if (source[i] !== place || !Number.isFinite(value)) return;
      (outcome[i] === OUTCOME.used || outcome[i] === OUTCOME.usedLate ? used : notUsed).push(i);
    });
    const points = [
      pointsLayer(times, innovation, used, {label: "used", colour: "used", marker: "dot"}),
      pointsLayer(times, innovation, notUsed, {label: "gated or without effect", colour: "gated", marker: "cross"}),
    ].filter((layer) => layer.times.length > 0);
    if (points.length === 0) return [];
    const unit = data.sensors.find((sensor) => sensor.name === name)?.unit;
    const made = [new Chart(withUnit(`${name}: |y − h(x̂)|`, unit),
                            {range: run.range, layers: [...modesLayer(), ...jumpsLayer(), ...points], hasLog: true})];
    const normalized = [...used, ...notUsed].filter((i) => Number.isFinite(nis[i]));
    if (normalized.length > 0) {
      const layer = pointsLayer(times, nis, normalized, {label: "normalized innovation squared", colour: "deviation", marker: "dot"});
      made.push(new Chart(`${name}: NIS`, {range: run.range, layers: [...modesLayer(), ...jumpsLayer(), layer], log: true, hasLog: true}));
    }
    return made;
  });
  if (charts.length === 0) return;
  grid(section("innovations", "Innovations",
               "The norm of what each sample differed by from what the estimate expected, before it took effect; "
               + "of a Kalman filter also the normalized innovation squared (NIS), whose mean is the number of outputs where Q and R are right."), charts);
}

function intervalsSection() {
  const charts = data.sensors.filter((sensor) => sensor.histogram).flatMap((sensor) => {
    const bounds = [{value: sensor.T1, label: "T1", colour: "jump"}];
    if (sensor.T2 !== null) bounds.push({value: sensor.T2, label: "T2", colour: "bad"});
    const series = new Series(unpackTimes(sensor.interval_times), sensor.intervals);
    const layers = [...bounds.map((bound) => ({kind: "level", setsScale: true, ...bound})),
                    {kind: "line", series, colour: "used", width: 1.2, label: "time since the sample before"}];
    return [
      new Histogram(sensor.name, {bins: sensor.histogram, marks: bounds, xLabel: "time between samples [s]"}),
      new Chart(sensor.name + " [s]", {range: run.range, layers}),
    ];
  });
  if (charts.length > 0) grid(section("intervals", "Times between samples", "", "Intervals"), charts);
}

function delaysSection() {
  const {latency, source, arrival, rewound} = run.events;
  const layers = data.events.sources.map((name, place) => {
    const own = [];
    source.forEach((each, i) => { if (each === place && Math.abs(latency[i]) < 1e4) own.push(i); });
    return pointsLayer(arrival, latency, own, {label: name, colour: "series-" + (place % 5), marker: "dot"});
  }).filter((layer) => layer.times.length > 0);
  if (layers.length === 0) return;
  const made = section("delays", "Delays",
                       "How long after their stamps events arrived, and how many later ones were applied again for each.");
  const charts = [new Chart("Arrival after the stamp [s]", {range: run.range, layers})];
  const late = [];
  rewound.forEach((count, i) => { if (count > 0) late.push(i); });
  if (late.length > 0) {
    charts.push(new Chart("Events applied again", {range: run.range, isWhole: true, layers: [
      pointsLayer(arrival, rewound, late, {label: "by an event that came late", colour: "late", marker: "diamond"})]}));
  } else {
    const all = layers.flatMap((layer) => Array.from(layer.values));
    charts.push(new Histogram("Arrival after the stamp", {bins: binned(all), xLabel: "[s]"}));
  }
  grid(made, charts);
}
