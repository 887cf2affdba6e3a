// Zooming and moving with the pointer: drag to zoom, shift and drag to move, Ctrl and wheel to zoom where the
// pointer is, double-click for all.

const CLICK = 5;  // pixels, within which a drag is none

function drawSelection(context, {x0, y0, x1, y1}) {
  context.fillStyle = colour("estimate");
  context.globalAlpha = 0.15;
  context.fillRect(Math.min(x0, x1), Math.min(y0, y1), Math.abs(x1 - x0), Math.abs(y1 - y0));
  context.globalAlpha = 1;
}

/** What a drag selects: times only where it is flat, values only where it is steep. */
function selectionOf(view, start, end) {
  const isFlat = Math.abs(end.y - start.y) < 14;
  const isSteep = !isFlat && Math.abs(end.x - start.x) < 14;
  const within = (value, low, high) => Math.max(low, Math.min(high, value));
  return {
    isFlat, isSteep,
    x0: isSteep ? view.left : within(start.x, view.left, view.right),
    x1: isSteep ? view.right : within(end.x, view.left, view.right),
    y0: isFlat ? view.top : within(start.y, view.top, view.bottom),
    y1: isFlat ? view.bottom : within(end.y, view.top, view.bottom),
  };
}

function listen(chart) {
  const {plot, range} = chart;
  let start = null;
  const place = (event) => {
    const box = plot.getBoundingClientRect();
    return {x: event.clientX - box.left, y: event.clientY - box.top};
  };
  const timeAt = (x) => {
    const {view} = chart;
    return view.from + (x - view.left) / (view.right - view.left) * (view.to - view.from);
  };

  plot.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !chart.view) return;
    start = {...place(event), moves: event.shiftKey, shown: range.shown};
    plot.setPointerCapture(event.pointerId);
  });
  plot.addEventListener("pointermove", (event) => {
    if (!chart.view) return;
    const now = place(event);
    if (start?.moves) {
      const {view} = chart;
      const by = (start.x - now.x) / (view.right - view.left) * (view.to - view.from);
      range.show(start.shown[0] + by, start.shown[1] + by, {remembers: false});
    } else if (start) {
      chart.selection = selectionOf(chart.view, start, now);
    }
    range.point(timeAt(now.x));
  });
  plot.addEventListener("pointerup", (event) => {
    const begun = start;
    const {selection} = chart;
    start = null;
    chart.selection = null;
    if (!begun || begun.moves || !selection) return;
    const end = place(event);
    if (Math.abs(end.x - begun.x) < CLICK && Math.abs(end.y - begun.y) < CLICK) return;
    if (!selection.isFlat) {
      const {view} = chart;
      const valueAtPixel = (y) => view.low + (view.bottom - y) / (view.bottom - view.top) * (view.high - view.low);
      chart.ownLimits = [valueAtPixel(Math.max(selection.y0, selection.y1)),
                         valueAtPixel(Math.min(selection.y0, selection.y1))];
    }
    if (!selection.isSteep) {
      const times = [timeAt(selection.x0), timeAt(selection.x1)].sort((a, b) => a - b);
      range.show(...times);
    } else {
      drawSoon(chart);
    }
  });
  plot.addEventListener("pointerleave", () => { if (!start) range.point(null); });
  plot.addEventListener("dblclick", () => {
    chart.ownLimits = null;
    range.reset();
    drawSoon(chart);
  });
  plot.addEventListener("wheel", (event) => {
    if (!event.ctrlKey || !chart.view) return;
    event.preventDefault();
    const factor = Math.exp(0.0015 * event.deltaY);
    const centre = timeAt(place(event).x);
    const [from, to] = range.shown;
    range.show(centre + (from - centre) * factor, centre + (to - centre) * factor, {remembers: false});
  }, {passive: false});
}
