const MARGIN = {left: 66, right: 12, top: 8, bottom: 24};

/** An element with properties and children. Texts from the data only ever become text. */
function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in made) made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

const allCharts = [];
const waitingCharts = new Set();

/** Draws once in the next frame, however often it is asked for; what is not in sight, when it comes there. */
function drawSoon(chart) {
  if (!chart.isInSight) {
    chart.isStale = true;
    return;
  }
  if (waitingCharts.size === 0) {
    requestAnimationFrame(() => {
      const charts = [...waitingCharts];
      waitingCharts.clear();
      for (const waiting of charts) waiting.draw();
    });
  }
  waitingCharts.add(chart);
}

const sight = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    const chart = allCharts.find((each) => each.figure === entry.target);
    chart.isInSight = entry.isIntersecting;
    if (chart.isInSight && chart.isStale) drawSoon(chart);
  }
}, {rootMargin: "300px"});
const resizes = new ResizeObserver((entries) => {
  for (const entry of entries) drawSoon(allCharts.find((each) => each.figure === entry.target));
});
addEventListener("beforeprint", () => allCharts.forEach((chart) => chart.draw()));

/** What all charts have: a frame with title, keys and tools, and a canvas. */
class Figure {
  constructor(title, height) {
    this.canvas = element("canvas");
    this.plot = element("div", {className: "plot"}, this.canvas);
    this.plot.style.height = height + "px";
    this.tools = element("span", {className: "tools"});
    this.plot.append(exportButtons(this));
    this.title = title;
    this.keys = [];  // layers with a key
    this.sheet = null;  // what is drawn on instead of the canvas, while it is exported
    this.caption = element("figcaption", {}, element("strong", {textContent: title}));
    this.figure = element("figure", {}, this.caption, this.plot);
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", title);
    this.isStale = true;
    this.isInSight = false;
    allCharts.push(this);
    sight.observe(this.figure);
    resizes.observe(this.figure);
  }

  /** The context of a canvas as large as its place, cleared, with its size in CSS pixels. */
  prepare(canvas = this.canvas) {
    if (this.sheet) return this.sheet;
    const ratio = devicePixelRatio || 1;
    const width = this.plot.clientWidth;
    const height = this.plot.clientHeight;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "12px system-ui, 'DejaVu Sans', sans-serif";
    this.isStale = false;
    return {context, width, height};
  }

  /** A key that shows and hides a layer. */
  addKey(layer) {
    const swatch = element("span", {className: "swatch"});
    const isThin = layer.kind === "line" || layer.kind === "level" || layer.kind === "stairs";
    swatch.style.background = `var(--${layer.colour})`;
    swatch.style.opacity = ["band", "interval"].includes(layer.kind) ? "0.35" : "1";
    if (isThin) swatch.style.height = "3px";
    if (["points", "marks"].includes(layer.kind)) swatch.style.width = layer.kind === "points" ? "8px" : "2px";
    if (layer.kind === "points") swatch.style.height = "8px";
    if (layer.marker === "dot") swatch.style.borderRadius = "50%";
    if (layer.marker === "diamond") swatch.style.transform = "rotate(45deg)";
    if (layer.marker === "cross") {
      swatch.style.background = "none";
      swatch.style.color = `var(--${layer.colour})`;
      swatch.className = "cross";
      swatch.textContent = "✕";
    }
    layer.readout = element("span", {className: "value"});
    const key = element("button", {className: "key" + (layer.isHidden ? " off" : ""), type: "button"},
                        swatch, layer.label, layer.readout);
    key.addEventListener("click", () => {
      layer.isHidden = !layer.isHidden;
      key.classList.toggle("off", layer.isHidden);
      drawSoon(this);
    });
    this.caption.append(key);
    this.keys.push(layer);
  }
}

/** The axes of a chart: ticks, grid and frame. */
function drawAxes(context, view, xLabel) {
  const {left, right, top, bottom} = view;
  context.strokeStyle = colour("grid");
  context.fillStyle = colour("muted");
  context.lineWidth = 1;
  context.beginPath();
  context.textAlign = "right";
  context.textBaseline = "middle";
  const rows = (bottom - top) / 38;
  for (const tick of view.log ? logTicks(view.low, view.high, rows) : linearTicks(view.low, view.high, rows, view.isWhole ? 1 : 0)) {
    const y = Math.round(bottom - (tick.value - view.low) / (view.high - view.low) * (bottom - top)) + 0.5;
    context.moveTo(left, y);
    context.lineTo(right, y);
    context.fillText(tick.label, left - 7, y, left - 10);
  }
  context.textAlign = "center";
  context.textBaseline = "top";
  const labelWidth = context.measureText(xLabel).width;
  for (const tick of linearTicks(view.from, view.to, (right - left) / 90)) {
    const x = Math.round(view.x(tick.value)) + 0.5;
    context.moveTo(x, top);
    context.lineTo(x, bottom);
    const half = context.measureText(tick.label).width / 2;
    if (x + half < right - labelWidth - 6) context.fillText(tick.label, x, bottom + 7);
  }
  context.stroke();
  context.textAlign = "right";
  context.fillText(xLabel, right, bottom + 7);
  context.strokeStyle = colour("line");
  context.strokeRect(left + 0.5, top + 0.5, right - left - 1, bottom - top - 1);
}

/** Layers over time, or over another quantity, on the axes of a TimeRange. */
class Chart extends Figure {
  constructor(title, {range, layers, height = 210, log = false, hasLog = false, isWhole = false, xLabel = "time [s]"}) {
    super(title, height);
    this.range = range;
    this.layers = layers;
    this.log = log;
    this.isWhole = isWhole;  // numbers of something
    this.xLabel = xLabel;
    this.ownLimits = null;  // of the values, where they were chosen
    this.overlay = element("canvas");
    this.plot.append(this.overlay);
    for (const layer of layers) if (layer.label) this.addKey(layer);
    if (hasLog) this.addLogButton();
    this.caption.append(this.tools);
    range.listeners.push({shown: () => drawSoon(this), pointed: () => this.drawCursor()});
    listen(this);
  }

  addLogButton() {
    const button = element("button", {type: "button", textContent: "log"});
    const show = () => button.setAttribute("aria-pressed", String(this.log));
    button.addEventListener("click", () => {
      this.log = !this.log;
      this.ownLimits = null;
      show();
      drawSoon(this);
    });
    show();
    this.tools.append(button);
  }

  /** The least and the largest value in sight, with some room. */
  limits(from, to) {
    if (this.ownLimits) return this.ownLimits;
    let low = Infinity;
    let high = -Infinity;
    const take = (least, largest) => {
      if (least < low) low = least;
      if (largest > high) high = largest;
    };
    const shown = this.layers.filter((layer) => !layer.isHidden);
    for (const layer of shown) takeLimits(layer, from, to, this.log, take);
    // A band that is far wider than all else does not set the scale.
    for (const layer of shown) if (layer.kind === "band") takeBand(layer, from, to, this.log, take, [low, high]);
    if (this.log) {
      low = Math.log10(low);
      high = Math.log10(high);
    }
    if (!(low <= high)) return [0, 1];
    const room = high > low ? 0.06 * (high - low) : this.log ? 0.5 : 0.05 * Math.abs(high) || 1;
    return [low - room, high + room];
  }

  draw() {
    const {context, width, height} = this.prepare();
    if (width < MARGIN.left + 40) return;
    const [from, to] = this.range.shown;
    const [low, high] = this.limits(from, to);
    const view = {from, to, low, high, log: this.log, isWhole: this.isWhole, left: MARGIN.left, right: width - MARGIN.right,
                  top: MARGIN.top, bottom: height - MARGIN.bottom};
    const perTime = (view.right - view.left) / (to - from);
    const perValue = (view.bottom - view.top) / (high - low);
    view.x = (time) => view.left + (time - from) * perTime;
    const beyond = 4 * height;  // what lies further off can't be told from it, but takes long to draw
    const at = (value) => Math.max(-beyond, Math.min(beyond, view.bottom - (value - low) * perValue));
    view.y = this.log ? (value) => (value > 0 ? at(Math.log10(value)) : value <= 0 ? beyond : NaN) : at;
    this.view = view;

    drawAxes(context, view, this.xLabel);
    context.save();
    context.beginPath();
    context.rect(view.left, view.top, view.right - view.left, view.bottom - view.top);
    context.clip();
    for (const layer of this.layers) if (!layer.isHidden) DRAWN_BY[layer.kind](context, view, layer);
    context.restore();
    this.drawCursor();
  }

  /** A line where the pointer is, on each linked chart, and the values there. */
  drawCursor() {
    if (!this.isInSight || !this.view || this.sheet) return;
    const {context} = this.prepare(this.overlay);
    const time = this.range.cursor;
    const isShown = time !== null && time >= this.view.from && time <= this.view.to;
    for (const layer of this.layers) {
      if (!layer.readout) continue;
      const value = isShown ? valueAt(layer, time) : null;
      layer.readout.textContent = value === null ? "" : value;
    }
    if (this.selection) drawSelection(context, this.selection);
    if (!isShown) return;
    const x = Math.round(this.view.x(time)) + 0.5;
    context.strokeStyle = colour("muted");
    context.beginPath();
    context.moveTo(x, this.view.top);
    context.lineTo(x, this.view.bottom);
    context.stroke();
  }
}

const MOST_OF_BAND = 3;  // of the height of the curve that it is around

/** About 400 finite values of a part of a series, in their order. */
function sortedValues(series, begin, end) {
  const {high} = series.level(0);
  const values = [];
  const step = Math.max(1, Math.floor((end - begin) / 400));
  for (let i = begin; i < end; i += step) if (Number.isFinite(high[i])) values.push(high[i]);
  return values.sort((a, b) => a - b);
}

/** The least positive value, but not far below three quarters of them: errors next to nothing at samples do not set a logarithmic scale. */
function lowerPart(series, begin, end) {
  const values = sortedValues(series, begin, end).filter((value) => value > 0);
  return values.length > 0 ? Math.max(values[0], 1e-3 * values[Math.floor(0.25 * values.length)]) : Infinity;
}

/** What a layer other than a band asks of the scale of values. */
function takeLimits(layer, from, to, log, take) {
  if (layer.kind === "line") {
    const [begin, end] = layer.series.indices(from, to);
    const [low, high] = layer.series.limits(begin, end);
    take(log ? lowerPart(layer.series, begin, end) : low, high);
  } else if (layer.kind === "points" || layer.kind === "stairs") {
    const begin = countBelow(layer.times, from);
    const end = countBelow(layer.times, to);
    for (let i = begin; i < end; ++i) {
      if (!log || layer.values[i] > 0) take(layer.values[i], layer.values[i]);
    }
    if (layer.kind === "stairs" && begin > 0) take(layer.values[begin - 1], layer.values[begin - 1]);
  } else if (layer.kind === "level" && layer.setsScale) {
    take(layer.value, layer.value);
  }
}

/** Bands are in sight as far as 19 of 20 of their entries reach, but not far beyond the rest. */
function takeBand(layer, from, to, log, take, [low, high]) {
  const widths = sortedValues(layer.width, ...layer.width.indices(from, to)).map((width) => width * (layer.factor ?? 1));
  if (widths.length === 0) return;
  const wide = widths[Math.floor(0.95 * (widths.length - 1))];
  if (log) {
    take(widths[0], widths[widths.length - 1]);
  } else if (layer.centre) {
    const most = MOST_OF_BAND * (high - low || wide);
    take(Math.max(low - wide, low - most), Math.min(high + wide, high + most));
  } else {
    take(-wide, wide);
  }
}

/** What the key of a layer says where the pointer is; null where there is nothing to say. */
function valueAt(layer, time) {
  if (layer.kind === "line" || layer.kind === "band") {
    const series = layer.series ?? layer.width;
    if (series.times.length === 0) return null;
    const i = series.indexAt(time);
    const {low, high} = series.level(0);
    const factor = layer.factor ?? 1;
    if (layer.kind === "band") return "±" + shortNumber(factor * high[i], 5);
    if (low[i] === high[i]) return shortNumber(high[i], 5);
    const ends = [low[i], high[i]].sort((a, b) => a - b);  // which rounding may have exchanged
    return ends.map((end) => shortNumber(end, 4)).join("…");
  }
  if (layer.kind === "stairs") {
    const i = countBelow(layer.times, time + 1e-9) - 1;
    return i >= 0 ? String(layer.values[i]) : null;
  }
  return null;
}
