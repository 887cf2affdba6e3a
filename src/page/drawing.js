// What layers of a chart look like. A view maps times and values to pixels: x(), y(), from, to, left, right,
// top, bottom.

const EVERY_POINT = 3;  // entries per pixel, beyond which levels are drawn
const DENSE = 4;        // pixels between marks, below which they say nothing

/** The entries of a series to draw: a level, and which of its entries. */
function entriesToDraw(series, view) {
  const [begin, end] = series.indices(view.from, view.to);
  const number = levelFor(end - begin, EVERY_POINT * (view.right - view.left));
  const size = LEVEL_FACTOR ** number;
  return {...series.level(number), size, begin: Math.floor(begin / size), end: Math.ceil(end / size)};
}

/** Whether a line must not be drawn across: where a jump lies between two entries, or an angle goes round. */
function breakFinder(series, layer) {
  const breaks = layer.breaks ?? [];
  const turns = layer.angular ? Math.PI : Infinity;
  return (entries, k) => {
    if (Math.abs(entries.low[k] - entries.low[k - 1]) > turns) return true;
    if (breaks.length === 0 || entries.size > 1) return false;
    const next = countBelow(breaks, series.times[k - 1] + 1e-9);
    return next < breaks.length && breaks[next] <= series.times[k] + 1e-9;
  };
}

/** Whether values grow around an entry that stands for several: then the least of them came first, most likely. */
function growsAt(entries, k) {
  const middle = (i) => entries.low[i] + entries.high[i];
  const before = middle(k - 1 >= entries.begin ? k - 1 : k);
  const after = middle(k + 1 < entries.end ? k + 1 : k);
  return !(after < before);
}

function drawLine(context, view, layer) {
  const {series} = layer;
  const entries = entriesToDraw(series, view);
  const isBand = series.isThinned || entries.size > 1;
  const isBroken = breakFinder(series, layer);
  context.strokeStyle = colour(layer.colour);
  context.lineWidth = layer.width ?? 1.4;
  context.lineJoin = "round";
  context.beginPath();
  let isDrawing = false;
  for (let k = entries.begin; k < entries.end; ++k) {
    const x = view.x(series.times[k * entries.size]);
    const grows = !isBand || growsAt(entries, k);
    const first = view.y((grows ? entries.low : entries.high)[k]);
    if (!Number.isFinite(first)) {
      isDrawing = false;
      continue;
    }
    if (isDrawing && !isBroken(entries, k)) context.lineTo(x, first);
    else context.moveTo(x, first);
    if (isBand) {
      const end = k + 1 < entries.end ? view.x(series.times[(k + 1) * entries.size]) : x;
      context.lineTo(end, view.y((grows ? entries.high : entries.low)[k]));
    }
    isDrawing = true;
  }
  context.stroke();
}

/** Around a series, or around zero: as wide as another one of the same times. */
function drawBand(context, view, layer) {
  const {centre, width} = layer;
  const widths = entriesToDraw(width, view);
  const centres = centre ? centre.level(Math.round(Math.log(widths.size) / Math.log(LEVEL_FACTOR))) : null;
  const isBroken = breakFinder(centre ?? width, {...layer, breaks: centre ? layer.breaks : []});
  context.fillStyle = colour(layer.colour);
  context.globalAlpha = layer.alpha ?? 0.16;
  const factor = layer.factor ?? 1;
  const isThinned = width.isThinned || widths.size > 1;
  const around = centres ? {...centres, begin: widths.begin, end: widths.end, size: widths.size} : null;
  let upper = [];
  let lower = [];
  const close = () => {
    if (upper.length > 1) {
      context.beginPath();
      for (const [x, y] of upper) context.lineTo(x, y);
      for (let i = lower.length - 1; i >= 0; --i) context.lineTo(...lower[i]);
      context.fill();
    }
    upper = [];
    lower = [];
  };
  for (let k = widths.begin; k < widths.end; ++k) {
    const x = view.x(width.times[k * widths.size]);
    const reach = factor * widths.high[k];
    if (!Number.isFinite(view.y((around ? around.high[k] : 0) + reach))) {
      close();
      continue;
    }
    if (around && upper.length > 0 && isBroken(around, k)) close();
    const push = (at, middle) => {
      upper.push([at, view.y(middle + reach)]);
      lower.push([at, view.y(view.log ? 0 : middle - reach)]);
    };
    const grows = !around || growsAt(around, k);
    push(x, around ? (grows ? around.low : around.high)[k] : 0);
    if (!isThinned) continue;
    const end = k + 1 < widths.end ? view.x(width.times[(k + 1) * widths.size]) : x;
    push(end, around ? (grows ? around.high : around.low)[k] : 0);
  }
  close();
  context.globalAlpha = 1;
}

const MARKERS = {
  dot: (context, x, y, size) => { context.moveTo(x + size, y); context.arc(x, y, size, 0, 7); },
  diamond: (context, x, y) => {
    context.moveTo(x, y - 4);
    for (const [dx, dy] of [[4, 0], [0, 4], [-4, 0], [0, -4]]) context.lineTo(x + dx, y + dy);
  },
  cross: (context, x, y) => {
    context.moveTo(x - 3.5, y - 3.5); context.lineTo(x + 3.5, y + 3.5);
    context.moveTo(x - 3.5, y + 3.5); context.lineTo(x + 3.5, y - 3.5);
  },
};

function drawPoints(context, view, layer) {
  const begin = countBelow(layer.times, view.from);
  const end = countBelow(layer.times, view.to);
  const perPoint = (view.right - view.left) / Math.max(1, end - begin);
  const isMany = perPoint < 0.7;
  const size = Math.max(1.3, Math.min(2.6, perPoint / 3));
  context.beginPath();
  let last = null;
  for (let i = begin; i < end; ++i) {
    const x = view.x(layer.times[i]);
    const y = view.y(layer.values[i]);
    if (!(y >= view.top - 3 && y <= view.bottom + 3)) continue;
    if (isMany && layer.marker !== "cross") {
      const pixel = Math.round(x) * 8192 + Math.round(y);
      if (pixel === last) continue;
      last = pixel;
      context.rect(x - 0.8, y - 0.8, 1.6, 1.6);
    } else {
      MARKERS[layer.marker](context, x, y, size);
    }
  }
  context.fillStyle = context.strokeStyle = colour(layer.colour);
  context.lineWidth = 1.6;
  if (layer.marker === "cross") context.stroke();
  else context.fill();
}

/** Marks at times: across the chart, or at its bottom. */
function drawMarks(context, view, layer) {
  const begin = countBelow(layer.times, view.from);
  const end = countBelow(layer.times, view.to);
  const isDense = (end - begin) * DENSE > view.right - view.left;
  if (isDense && !layer.atBottom) return;
  context.strokeStyle = colour(layer.colour);
  context.lineWidth = 1;
  context.globalAlpha = !layer.atBottom ? 0.6 : isDense ? 0.35 : 1;
  context.setLineDash(layer.atBottom ? [] : [2, 3]);
  context.beginPath();
  let last = -1;
  for (let i = begin; i < end; ++i) {
    const x = Math.round(view.x(layer.times[i])) + 0.5;
    if (x === last) continue;
    last = x;
    context.moveTo(x, view.bottom);
    context.lineTo(x, layer.atBottom ? view.bottom - 8 : view.top);
  }
  context.stroke();
  context.setLineDash([]);
  context.globalAlpha = 1;
}

/** Modes: from each time to the next. */
function drawSpans(context, view, layer) {
  layer.times.forEach((time, i) => {
    const left = Math.max(view.left, view.x(time));
    const right = Math.min(view.right, i + 1 < layer.times.length ? view.x(layer.times[i + 1]) : view.right);
    if (right <= left) return;
    const place = layer.order.indexOf(layer.labels[i]);
    context.fillStyle = colour("series-" + (place % 5));
    context.globalAlpha = 0.08;
    context.fillRect(left, view.top, right - left, view.bottom - view.top);
    context.globalAlpha = 1;
    if (right - left > 26) {
      context.fillStyle = colour("muted");
      context.textAlign = "left";
      context.textBaseline = "top";
      context.fillText(layer.labels[i], left + 4, view.top + 3);
    }
  });
}

/** A part of the axis. */
function drawInterval(context, view, layer) {
  const left = Math.max(view.left, view.x(layer.from));
  const right = Math.min(view.right, view.x(layer.to));
  context.fillStyle = colour(layer.colour);
  context.globalAlpha = 0.14;
  context.fillRect(left, view.top, right - left, view.bottom - view.top);
  context.globalAlpha = 1;
}

/** Where there is no value: crosses on top, in a row for each layer, so that they don't hide each other. */
function drawAbsent(context, view, layer) {
  const y = view.top + 10 + 11 * layer.row;
  context.strokeStyle = colour(layer.colour);
  context.lineWidth = 1.6;
  context.beginPath();
  for (const time of layer.times) {
    const x = view.x(time);
    if (x >= view.left && x <= view.right) MARKERS.cross(context, x, y);
  }
  context.stroke();
}

/** A line at a value, with its name. */
function drawLevel(context, view, layer) {
  const y = view.y(layer.value);
  if (!(y >= view.top && y <= view.bottom)) return;
  context.strokeStyle = colour(layer.colour);
  context.lineWidth = 1.2;
  context.setLineDash([6, 4]);
  context.beginPath();
  context.moveTo(view.left, y);
  context.lineTo(view.right, y);
  context.stroke();
  context.setLineDash([]);
}

/** From each time to the next at one value. */
function drawStairs(context, view, layer) {
  context.strokeStyle = colour(layer.colour);
  context.lineWidth = 1.4;
  context.beginPath();
  layer.times.forEach((time, i) => {
    const y = view.y(layer.values[i]);
    const x = view.x(time);
    if (i === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
    context.lineTo(i + 1 < layer.times.length ? view.x(layer.times[i + 1]) : view.x(view.to), y);
  });
  context.stroke();
}

const DRAWN_BY = {
  absent: drawAbsent,
  band: drawBand,
  interval: drawInterval,
  level: drawLevel,
  line: drawLine,
  marks: drawMarks,
  points: drawPoints,
  spans: drawSpans,
  stairs: drawStairs,
};
