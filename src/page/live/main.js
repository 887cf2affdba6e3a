// The live page: what the server tells, over the last seconds, in the charts of a report.

const OUTCOMES = {used: [0], late: [1], gated: [11]};  // as EventStatus has them; all others: rejected
const SHOWN_EVENTS = 40;
const CHECKED = ["", "", "below T1", "above T2"];

const live = {};

function startAnew() {
  Object.assign(live, {names: [], estimates: [], compared: [], events: [], charts: [], shape: "", last: 0, counts: new Map(), total: 0,
                       sinceStart: 0, began: null, wall: null});
}

function groupOf(outcome) {
  return Object.keys(OUTCOMES).find((group) => OUTCOMES[group].includes(outcome)) ?? "rejected";
}

const isUsed = (event) => event.outcome === 0 || event.outcome === 1;
const unit = (name) => data.units[name] ?? "";
const titled = (text, name) => (unit(name) ? `${text} [${unit(name)}]` : text);

/** The numbers of a key over entries, NaN where there is none. */
function columnOf(entries, read) {
  return Float64Array.from(entries, (entry) => read(entry) ?? NaN);
}

function seriesOf(entries, read) {
  return Series.of(columnOf(entries, (entry) => entry.t), columnOf(entries, read));
}

/** A layer that is made anew of what is there. */
function following(layer, update) {
  return Object.assign(layer, {update: () => Object.assign(layer, update())});
}

function lineLayer(properties, entries, read) {
  return following({kind: "line", series: seriesOf([], read), ...properties},
                   () => ({series: seriesOf(entries(), read), breaks: live.jumps}));
}

function bandLayer(properties, entries, centre, width) {
  const made = () => ({centre: centre ? seriesOf(entries(), centre) : null, width: seriesOf(entries(), width), breaks: live.jumps});
  return following({kind: "band", colour: "estimate", ...made(), ...properties}, made);
}

function pointsLayerOf(properties, entries, read) {
  const made = () => {
    const kept = entries().filter((entry) => read(entry) !== null && read(entry) !== undefined).sort((a, b) => a.t - b.t);
    return {times: columnOf(kept, (entry) => entry.t), values: columnOf(kept, read)};
  };
  return following({kind: "points", ...made(), marker: "dot", ...properties}, made);
}

function jumpsLayerOf() {
  return live.jumps.length > 0 ? [following({kind: "marks", times: live.jumps, colour: "jump", label: "jumps"}, () => ({times: live.jumps}))] : [];
}

const STYLES = {
  used: {label: "samples used", colour: "used", marker: "dot"},
  late: {label: "used late", colour: "late", marker: "diamond"},
  gated: {label: "gated", colour: "gated", marker: "cross"},
  rejected: {label: "rejected", colour: "rejected", marker: "cross"},
};

/** What was measured of a state; of a state that no sensor measures itself, when there was a sample. */
function sampleLayers(place) {
  const outputs = Object.entries(data.sensors)
    .flatMap(([name, sensor]) => sensor.states.map((state, i) => ({name, state, i}))).filter((output) => output.state === live.names[place]);
  if (outputs.length === 0) {
    const times = () => columnOf(live.events.filter((event) => event.kind === 5 && isUsed(event)), (event) => event.t).sort();
    return [following({kind: "marks", atBottom: true, times: times(), colour: "used", label: "times of samples"}, () => ({times: times()}))];
  }
  return outputs.flatMap(({name, i}) => Object.keys(STYLES).filter((group) => hasPoints(name, group)).map((group) => pointsLayerOf(
    STYLES[group], () => live.events.filter((event) => event.source === name && groupOf(event.outcome) === group), (event) => event.values[i])));
}

function hasPoints(source, group) {
  return live.events.some((event) => event.source === source && event.values.length > 0 && groupOf(event.outcome) === group);
}

function stateCharts(place) {
  const name = live.names[place];
  const [newest] = live.estimates.slice(-1);
  const entries = () => live.estimates;
  const layers = [...jumpsLayerOf()];
  if (newest.bounds.length > 0) {
    layers.push(bandLayer({label: "guaranteed bound"}, entries, (entry) => entry.x[place], (entry) => entry.bounds[place]));
  }
  if (newest.deviations.length > 0) {
    layers.push(bandLayer({label: "3σ", factor: 3, colour: "deviation"}, entries, (entry) => entry.x[place], (entry) => entry.deviations[place]));
  }
  const hasTruth = live.compared.some((entry) => entry.truth[place] !== null);
  if (hasTruth) layers.push(lineLayer({colour: "truth", width: 2.6, label: "truth"}, () => live.compared, (entry) => entry.truth[place]));
  layers.push(...sampleLayers(place), lineLayer({colour: "estimate", label: "estimate"}, entries, (entry) => entry.x[place]));
  const charts = [new Chart(titled(name, name), {range: live.range, layers})];
  if (hasTruth) {
    const errors = () => live.compared.filter((entry) => entry.estimate);
    const own = [...jumpsLayerOf()];
    if (newest.bounds.length > 0) own.push(bandLayer({label: "guaranteed bound"}, errors, null, (entry) => entry.estimate.bounds[place]));
    if (newest.deviations.length > 0) own.push(bandLayer({label: "3σ", factor: 3, colour: "deviation"}, errors, null, (entry) => entry.estimate.deviations[place]));
    own.push(lineLayer({colour: "error", label: "error x̂ − x"}, errors, (entry) => entry.estimate.x[place] - entry.truth[place]));
    charts.push(new Chart(titled("Error of " + name, name), {range: live.range, layers: own}));
  }
  return charts;
}

function normChart() {
  const norm = (entry) => Math.hypot(...entry.truth.map((x, i) => x === null ? 0 : entry.estimate.x[i] - x));
  const layers = [...jumpsLayerOf()];
  if (live.estimates.some((entry) => entry.bound !== null)) {
    layers.push(lineLayer({colour: "hold", width: 1.8, label: "guaranteed bound"}, () => live.estimates, (entry) => entry.bound));
  }
  if (live.compared.length > 0) {
    layers.push(lineLayer({colour: "error", label: "norm of the error"}, () => live.compared.filter((entry) => entry.estimate), norm));
  }
  return layers.some((layer) => layer.kind === "line")
    ? [new Chart("Norm of the error", {range: live.range, layers, log: true, hasLog: true, height: 240})] : [];
}

function sensorCharts() {
  const measured = [...new Set(live.events.filter((event) => event.values.length > 0 && event.kind !== 0).map((event) => event.source))];
  return measured.flatMap((name) => {
    const own = () => live.events.filter((event) => event.source === name);
    const times = data.sensors[name] ?? {T1: null, T2: null};
    const bounds = [["T1", "jump"], ["T2", "bad"]].filter(([key]) => times[key] !== null)
      .map(([key, colour]) => ({kind: "level", setsScale: true, value: times[key], label: key, colour}));
    return [
      new Chart(titled(`${name}: |y − h(x̂)|`, name), {range: live.range, hasLog: true, layers: [...jumpsLayerOf(),
        pointsLayerOf(STYLES.used, () => own().filter(isUsed), (event) => event.innovation.length > 0 ? Math.hypot(...event.innovation) : null),
        pointsLayerOf({...STYLES.gated, label: "gated or without effect"}, () => own().filter((event) => !isUsed(event)),
                      (event) => event.innovation.length > 0 ? Math.hypot(...event.innovation) : null)]}),
      new Chart(`${name}: time since the sample before [s]`, {range: live.range, layers: [...bounds,
        pointsLayerOf({label: "interval", colour: "used"}, () => own().filter(isUsed), (event) => event.interval)]}),
    ];
  });
}

function latencyChart() {
  const sources = [...new Set(live.events.map((event) => event.source))];
  if (sources.length === 0) return [];
  return [new Chart("Arrival after the stamp [s]", {range: live.range, layers: sources.map((name, i) => pointsLayerOf(
    {label: name, colour: "series-" + (i % 7)}, () => live.events.filter((event) => event.source === name), (event) => event.latency))})];
}

/** What the charts are about: where that changes they are made anew. */
function shapeNow() {
  const [newest] = live.estimates.slice(-1);
  if (!newest) return "";
  const groups = [...new Set(live.events.map((event) => event.source + groupOf(event.outcome) + (event.values.length > 0)))].sort();
  return JSON.stringify([live.names, newest.bounds.length, newest.deviations.length, live.compared.length > 0, live.jumps.length > 0, groups]);
}

function build() {
  document.getElementById("main").replaceChildren();
  document.getElementById("toolbar").replaceChildren();
  for (const chart of allCharts) {
    sight.unobserve(chart.figure);
    resizes.unobserve(chart.figure);
  }
  allCharts.length = sections.length = 0;
  live.range.listeners.length = 0;
  live.status = section("status", "Now").appendChild(element("ul", {className: "findings plain"}));
  if (live.estimates.length === 0) {
    live.status.append(element("li", {className: "open", textContent: "Waiting for the first estimate."}));
    makeToolbar();
    return;
  }
  const states = live.names.map((_, place) => stateCharts(place));
  grid(section("states", "States", "Drag to zoom, Shift and drag to move; double-click, or \"whole run\", follows the newest again."),
       states.flat(), states.length === 1 && states[0].length === 1);
  const norm = normChart();
  if (norm.length > 0) grid(section("norm", "Norm of the error", "", "Norm"), norm);
  const sensors = sensorCharts();
  if (sensors.length > 0) grid(section("sensors", "Innovations and intervals", "", "Sensors"), sensors);
  const latency = latencyChart();
  if (latency.length > 0) grid(section("delays", "Delays"), latency);
  live.table = section("events", "Events", `The newest ${SHOWN_EVENTS}.`).appendChild(element("div"));
  live.charts = [...allCharts];
  makeToolbar(live.range);
}

function tell(level, text) {
  live.status.append(element("li", {className: level, textContent: text}));
}

function showStatus() {
  live.status.replaceChildren();
  const [newest] = live.estimates.slice(-1);
  if (!newest) return;
  if (live.isOver) tell("open", live.isOver);
  const rate = live.rate === null ? "" : `, ${shortNumber(live.rate, 3)} of them per second`;
  tell(newest.flags.length > 0 ? "warning" : "good", `Estimate at ${newest.t.toFixed(2)} s${rate}`
    + (newest.flags.length > 0 ? ": " + newest.flags.map((flag) => flag.replaceAll("_", " ")).join(", ") : ""));
  if (newest.bounds.length > 0) {
    tell(newest.bound === null ? "warning" : "good", newest.bound === null ? "No guaranteed bound now"
      : `Guaranteed: the error is at most ${shortNumber(newest.bound, 3)} (norm)`);
  }
  const outside = live.compared.filter((entry) => entry.estimate?.bounds.some(
    (bound, i) => bound !== null && entry.truth[i] !== null && Math.abs(entry.estimate.x[i] - entry.truth[i]) > bound)).length;
  if (live.compared.length > 0 && newest.bounds.length > 0) {
    tell(outside > 0 ? "bad" : "good", outside > 0 ? `The error is larger than its bound at ${outside} stamps`
      : "The error was within its bound at each compared stamp");
  }
  const counted = ["used", "late", "gated", "rejected"].filter((group) => live.counts.get(group) > 0)
    .map((group) => `${live.counts.get(group)} ${{late: "used late"}[group] ?? group}`);
  tell(live.counts.get("rejected") > 0 ? "warning" : "good", `Events: ${counted.join(", ") || "none yet"}`);
}

function showTable() {
  const rows = live.events.slice(-SHOWN_EVENTS).reverse().map((event) => [
    cell(event.t.toFixed(3)), cell(event.source, "text"), cell(event.reason, "text wide " + (isUsed(event) ? "" : "warning")),
    cell(shortNumber(event.latency)), cell(shortNumber(event.interval)), cell(CHECKED[event.check], "text warning"), cell(event.rewound || "")]);
  live.table?.replaceChildren(tableOf(["stamp [s]", "source", "outcome", "latency [s]", "interval [s]", "", "rewound"], [1, 2, 5], rows));
}

/** Forgets what is older than the page shows. */
function trim(entries, before) {
  let count = 0;
  while (count < entries.length && entries[count].t < before) ++count;
  if (count > 0) entries.splice(0, count);
}

function take(batch) {
  live.names = batch.names;
  live.estimates.push(...batch.estimates);
  const known = new Map(live.estimates.map((entry) => [entry.t, entry]));
  for (const entry of batch.compared) live.compared.push({...entry, estimate: known.get(entry.t)});
  live.compared.sort((a, b) => a.t - b.t);
  live.events.push(...batch.events);
  for (const event of batch.events) live.counts.set(groupOf(event.outcome), (live.counts.get(groupOf(event.outcome)) ?? 0) + 1);
  if (live.wall !== null && batch.wall > live.wall) {
    const now = batch.count / (batch.wall - live.wall);
    live.rate = live.rate === null ? now : 0.95 * live.rate + 0.05 * now;
  }
  live.wall = batch.wall;
  const [newest] = live.estimates.slice(-1);
  if (!newest) return;
  live.last = newest.t;
  for (const entries of [live.estimates, live.compared, live.events]) trim(entries, live.last - data.seconds);
}

function refresh() {
  live.jumps = columnOf(live.events.filter((event) => event.kind === 1 && isUsed(event)), (event) => event.t).sort();
  const first = live.estimates.length > 0 ? live.estimates[0].t : 0;
  const follows = live.range.isWhole;
  live.range.whole = [first, Math.max(first + 1, live.last)];
  if (follows) live.range.shown = live.range.whole;
  const shape = shapeNow();
  if (shape !== live.shape) {
    live.shape = shape;
    build();
  }
  for (const chart of live.charts) for (const layer of chart.layers ?? []) layer.update?.();
  live.range.tell();
  showStatus();
  showTable();
}

beginPage(data.title, `The last ${data.seconds} s, as they come. Times are in seconds after the first stamp.`);
startAnew();
live.rate = null;
live.jumps = new Float64Array();
live.range = new TimeRange(0, 1);
build();
let isWaiting = false;
const stream = new EventSource("stream");
stream.onmessage = (message) => {
  const batch = JSON.parse(message.data);
  if (batch.restart) {
    startAnew();
    live.isOver = "";
    live.rate = null;
    return;
  }
  if (batch.ended) live.isOver = "The live view has ended; this is what it showed last.";
  else take(batch);
  if (isWaiting) return;
  isWaiting = true;  // batches that come together are drawn once
  setTimeout(() => {
    isWaiting = false;
    refresh();
  }, 30);
};
stream.onerror = () => {
  live.isOver = "The live view does not answer; this is what it showed last.";
  if (live.status) showStatus();
};
