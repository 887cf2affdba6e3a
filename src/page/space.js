/** Curves in space, seen from far away: drag to turn. The part in the span of time that is shown. */
class Space extends Figure {
  /**
   * @param curves  [{label, colour, width, points: range => [[x, y, z], ...]}], with null for gaps
   * @param names   of the axes
   * @param isEqual whether all axes have the same scale
   */
  constructor(title, {range, curves, names, isEqual = false, height = 460}) {
    super(title, height);
    Object.assign(this, {range, curves, names, isEqual, azimuth: -2.2, elevation: 0.42});
    for (const curve of curves) this.addKey(Object.assign(curve, {kind: "line"}));
    this.caption.append(this.tools);
    range.listeners.push({shown: () => drawSoon(this)});
    this.plot.classList.add("turns");
    let last = null;
    this.plot.addEventListener("pointerdown", (event) => {
      last = event;
      this.plot.setPointerCapture(event.pointerId);
    });
    this.plot.addEventListener("pointermove", (event) => {
      if (!last) return;
      this.azimuth -= 0.008 * (event.clientX - last.clientX);
      this.elevation += 0.008 * (event.clientY - last.clientY);
      this.elevation = Math.max(-1.5, Math.min(1.5, this.elevation));
      last = event;
      drawSoon(this);
    });
    this.plot.addEventListener("pointerup", () => { last = null; });
  }

  draw() {
    const {context, width, height} = this.prepare();
    if (width < 120) return;
    const shown = this.curves.filter((curve) => !curve.isHidden)
      .map((curve) => ({...curve, points: curve.points(this.range)}));
    const limits = [0, 1, 2].map((axis) => limitsOf(shown, axis));
    const lengths = limits.map(({low, high}) => high - low);
    const longest = Math.max(...lengths);
    const sides = this.isEqual ? lengths.map((length) => Math.max(0.02, length / longest)) : [1.35, 0.9, 0.75];
    const [sinA, cosA, sinE, cosE] = [Math.sin(this.azimuth), Math.cos(this.azimuth),
                                      Math.sin(this.elevation), Math.cos(this.elevation)];
    const turned = (u) => {  // from [0, 1] along each axis
      const [x, y, z] = u.map((value, axis) => (value - 0.5) * sides[axis]);
      return [-x * sinA + y * cosA, (x * cosA + y * sinA) * sinE - z * cosE];
    };
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => turned([i & 1, i >> 1 & 1, i >> 2 & 1]));
    const reach = [0, 1].map((side) => Math.max(...corners.map((corner) => corner[side])));
    const size = Math.min((width / 2 - 70) / reach[0], (height / 2 - 40) / reach[1]);
    const project = (u) => {
      const [x, y] = turned(u);
      return [width / 2 + size * x, height / 2 - 8 + size * y];
    };
    const place = (point) => project(point.map((value, axis) => (value - limits[axis].low) / lengths[axis]));
    this.drawBox(context, limits, project);
    for (const curve of shown) {
      context.strokeStyle = colour(curve.colour);
      context.lineWidth = curve.width;
      strokePath(context, curve.points.map((point) => (point ? place(point) : [NaN, NaN])));
    }
  }

  /** The edges of the box around the curves, ticks along the lowest, and names. */
  drawBox(context, limits, project) {
    context.strokeStyle = colour("line");
    context.lineWidth = 1;
    for (let axis = 0; axis < 3; ++axis) {
      const edges = [[0, 0], [0, 1], [1, 0], [1, 1]].map((others) => {
        const end = (value) => {
          const u = [...others];
          u.splice(axis, 0, value);
          return u;
        };
        return {begin: end(0), end: end(1), from: project(end(0)), to: project(end(1))};
      });
      for (const {from, to} of edges) strokePath(context, [from, to]);
      // Upright axes on the left, the others where the box is lowest.
      const rank = ({from, to}) => (axis === 2 ? from[0] + to[0] : -(from[1] + to[1]));
      const edge = edges.reduce((best, each) => (rank(each) < rank(best) ? each : best));
      this.drawTicks(context, axis, limits[axis], edge, project);
    }
  }

  drawTicks(context, axis, {low, high}, {begin, end, from, to}, project) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    if (length < 30) return;
    context.fillStyle = colour("muted");
    context.textAlign = axis === 2 ? "right" : "center";
    context.textBaseline = axis === 2 ? "middle" : "top";
    const [dx, dy] = axis === 2 ? [-8, 0] : [0, 7];
    for (const tick of linearTicks(low, high, length / 70)) {
      const share = (tick.value - low) / (high - low);
      const [x, y] = project(begin.map((value, i) => value + share * (end[i] - value)));
      context.fillText(tick.label, x + dx, y + dy);
    }
    context.fillStyle = colour("text");
    if (axis === 2) {
      const top = from[1] < to[1] ? from : to;
      context.textAlign = "center";
      context.fillText(this.names[axis], top[0], top[1] - 12);
    } else {
      context.fillText(this.names[axis], (from[0] + to[0]) / 2, (from[1] + to[1]) / 2 + dy + 18);
    }
  }
}
