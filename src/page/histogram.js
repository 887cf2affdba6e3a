/** How often values lie where: bins of one width, and marks at values. */
class Histogram extends Figure {
  /** @param bins {low, high, counts}: counts from low to high */
  constructor(title, {bins, marks = [], xLabel, height = 210, fill = "estimate"}) {
    super(title, height);
    Object.assign(this, {bins, xLabel, fill});
    this.marks = marks.map((mark) => ({kind: "level", ...mark}));
    for (const mark of this.marks) this.addKey(mark);
    this.caption.append(this.tools);
  }

  draw() {
    const {context, width, height} = this.prepare();
    if (width < MARGIN.left + 40) return;
    const {low, high, counts} = this.bins;
    const shown = this.marks.filter((mark) => !mark.isHidden);
    const all = [low, high, ...shown.map((mark) => mark.value)];
    const room = 0.04 * (Math.max(...all) - Math.min(...all));
    const view = {from: Math.min(...all) - room, to: Math.max(...all) + room,
                  low: 0, high: 1.08 * Math.max(1, ...counts), log: false, isWhole: true,
                  left: MARGIN.left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom};
    view.x = (value) => view.left + (value - view.from) / (view.to - view.from) * (view.right - view.left);
    view.y = (count) => view.bottom - count / view.high * (view.bottom - view.top);
    drawAxes(context, view, this.xLabel);
    context.fillStyle = colour(this.fill);
    context.globalAlpha = 0.75;
    const step = (high - low) / counts.length;
    counts.forEach((count, i) => {
      if (count === 0) return;
      const left = view.x(low + i * step);
      const right = Math.max(left + 1.5, view.x(low + (i + 1) * step) - 0.5);
      const y = Math.min(view.bottom - 1, view.y(count));
      context.fillRect(left, y, right - left, view.bottom - y);
    });
    context.globalAlpha = 1;
    context.setLineDash([6, 4]);
    context.lineWidth = 1.6;
    for (const mark of shown) {
      const x = view.x(mark.value);
      context.strokeStyle = colour(mark.colour);
      context.beginPath();
      context.moveTo(x, view.top);
      context.lineTo(x, view.bottom);
      context.stroke();
    }
    context.setLineDash([]);
  }
}

/** Bins of finite values. */
function binned(values, count = 60) {
  const finite = Array.from(values).filter(Number.isFinite);
  let low = Infinity;
  let high = -Infinity;
  for (const value of finite) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (!(low <= high)) return null;
  if (high === low) [low, high] = [low - 0.5e-6 - 0.01 * Math.abs(low), high + 0.5e-6 + 0.01 * Math.abs(high)];
  const counts = new Array(count).fill(0);
  for (const value of finite) {
    ++counts[Math.min(count - 1, Math.floor((value - low) / (high - low) * count))];
  }
  return {low, high, counts};
}
