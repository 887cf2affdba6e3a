const MOST_POINTS = 30000;

/** The middle of an entry of a series. */
function middleAt(series, i) {
  const {low, high} = series.level(0);
  return (low[i] + high[i]) / 2;
}

/** The points of a curve in the span of time that is shown, not more than can be drawn at once. */
function pointsOf(curve, range) {
  const [from, to] = range.shown;
  const [begin, end] = curve.axes[0].indices(from, to);
  const step = Math.max(1, Math.ceil((end - begin) / MOST_POINTS));
  const points = [];
  for (let i = begin; i < end; i += step) points.push(curve.axes.map((series) => middleAt(series, i)));
  return points;
}

/** Curves on a plane, with the same scale on both axes: the part in the span of time that is shown. */
class Plane extends Figure {
  /** @param curves [{label, colour, width, axes: [Series, Series]}] @param names of the two axes */
  constructor(title, {range, curves, names, height = 460}) {
    super(title, height);
    Object.assign(this, {range, curves, names});
    for (const curve of curves) this.addKey(Object.assign(curve, {kind: "line"}));
    range.listeners.push({shown: () => drawSoon(this), pointed: () => this.drawCursor()});
    this.caption.append(this.tools);
    this.overlay = element("canvas");
    this.plot.append(this.overlay);
    this.plot.style.cursor = "default";
  }

  draw() {
    const {context, width, height} = this.prepare();
    if (width < MARGIN.left + 40) return;
    const shown = this.curves.filter((curve) => !curve.isHidden)
      .map((curve) => ({...curve, points: pointsOf(curve, this.range)}));
    const view = {left: MARGIN.left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom};
    const [x, y] = [0, 1].map((axis) => limitsOf(shown, axis));
    const perUnit = Math.min((view.right - view.left) / (x.high - x.low), (view.bottom - view.top) / (y.high - y.low)) * 0.92;
    const halfWidth = (view.right - view.left) / perUnit / 2;
    const halfHeight = (view.bottom - view.top) / perUnit / 2;
    const centre = [(x.low + x.high) / 2, (y.low + y.high) / 2];
    Object.assign(view, {from: centre[0] - halfWidth, to: centre[0] + halfWidth,
                         low: centre[1] - halfHeight, high: centre[1] + halfHeight, log: false});
    view.x = (value) => view.left + (value - view.from) * perUnit;
    view.y = (value) => view.bottom - (value - view.low) * perUnit;
    this.view = view;
    drawAxes(context, view, this.names[0]);
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillStyle = colour("muted");
    context.fillText(this.names[1], view.left + 6, view.top + 5);
    for (const curve of shown) {
      context.strokeStyle = colour(curve.colour);
      context.lineWidth = curve.width;
      context.lineJoin = "round";
      strokePath(context, curve.points.map(([px, py]) => [view.x(px), view.y(py)]));
    }
    this.drawCursor();
  }

  /** Where each curve is at the time under the pointer. */
  drawCursor() {
    if (!this.isInSight || !this.view || this.sheet) return;
    const {context} = this.prepare(this.overlay);
    if (this.range.cursor === null) return;
    for (const curve of this.curves) {
      if (curve.isHidden) continue;
      const i = curve.axes[0].indexAt(this.range.cursor);
      const [px, py] = curve.axes.map((series) => middleAt(series, i));
      if (!Number.isFinite(px + py)) continue;
      context.fillStyle = colour(curve.colour);
      context.beginPath();
      context.arc(this.view.x(px), this.view.y(py), 5, 0, 7);
      context.fill();
    }
  }
}

/** The least and the largest finite coordinate of curves along an axis, never the same. Gaps are null. */
function limitsOf(curves, axis) {
  let low = Infinity;
  let high = -Infinity;
  for (const {points} of curves) {
    for (const point of points) {
      if (point === null) continue;
      if (point[axis] < low) low = point[axis];
      if (point[axis] > high) high = point[axis];
    }
  }
  if (!(low <= high)) return {low: 0, high: 1};
  const least = Math.max(1e-9, 1e-6 * Math.max(Math.abs(low), Math.abs(high)));
  return high - low < least ? {low: low - least, high: high + least} : {low, high};
}

/** A line through points, with gaps where they are not finite. */
function strokePath(context, points) {
  context.beginPath();
  let isDrawing = false;
  for (const [x, y] of points) {
    if (!Number.isFinite(x + y)) {
      isDrawing = false;
      continue;
    }
    if (isDrawing) context.lineTo(x, y);
    else context.moveTo(x, y);
    isDrawing = true;
  }
  context.stroke();
}
