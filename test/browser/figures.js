// Run before a page's own scripts: notes the texts that charts draw, and checks what they show.
(() => {
  // Charts out of sight are not drawn, and a window in which all are in sight takes long to paint: sight goes further here.
  const Observer = window.IntersectionObserver;
  window.IntersectionObserver = class extends Observer {
    constructor(told) { super(told, {rootMargin: "100000px"}); }
  };
  const {getContext} = HTMLCanvasElement.prototype;
  HTMLCanvasElement.prototype.getContext = function (kind) { return getContext.call(this, kind, {willReadFrequently: true}); };

  const drawn = new Map();  // of each canvas, what it says since it was last cleared
  const {clearRect, fillText} = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.clearRect = function (...place) {
    drawn.set(this.canvas, []);
    return clearRect.apply(this, place);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, x, y, most = Infinity) {
    const width = Math.min(most, this.measureText(text).width);
    const left = x - width * {left: 0, center: 0.5, right: 1}[this.textAlign];
    const top = y - 12 * {top: 0, middle: 0.5, alphabetic: 0.8}[this.textBaseline];
    drawn.get(this.canvas)?.push({text, left, right: left + width, top, bottom: top + 12, isOnLeft: this.textAlign === "right" && left < 66});
    return fillText.call(this, text, x, y, most);
  };

  const frames = async (count = 2) => { while (count-- > 0) await new Promise((resolve) => requestAnimationFrame(resolve)); };
  const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 0.5
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.5;
  const titleOf = (figure) => figure.querySelector("strong").textContent;
  const textsOf = (figure) => drawn.get(figure.querySelector("canvas")) ?? [];
  const figures = () => [...document.querySelectorAll("figure")];

  /** A number for what a canvas shows. */
  function pictureOf(figure) {
    const canvas = figure.querySelector("canvas");
    const bytes = new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer);
    let sum = 0;
    for (let i = 0; i < bytes.length; ++i) sum = (Math.imul(sum, 31) + bytes[i]) | 0;
    return sum;
  }

  /** What lies on what, or beyond where it belongs. */
  function faultsOf(figure) {
    const faults = [];
    const frame = figure.getBoundingClientRect();
    const canvas = figure.querySelector("canvas").getBoundingClientRect();
    const parts = [...figure.querySelectorAll("strong, .key, .tools > *")].map((part) => ({text: part.textContent, box: part.getBoundingClientRect()}));
    parts.forEach(({text, box}, i) => {
      if (box.left < frame.left || box.right > frame.right || box.bottom > canvas.top + 1) faults.push(`"${text}" leaves the heading`);
      for (const other of parts.slice(i + 1)) if (overlap(box, other.box)) faults.push(`"${text}" lies on "${other.text}"`);
    });
    const isTurned = figure.querySelector(".turns") !== null;  // where labels may meet at a corner
    textsOf(figure).forEach((text, i, all) => {
      if (text.left < -0.5 || text.right > canvas.width + 0.5 || text.bottom > canvas.height + 0.5) faults.push(`"${text.text}" is cut`);
      for (const other of all.slice(i + 1)) if (!isTurned && overlap(text, other)) faults.push(`"${text.text}" lies on "${other.text}"`);
    });
    return faults.map((fault) => `${titleOf(figure)}: ${fault}`);
  }

  const numberOf = (text) => Number(text.replaceAll("−", "-"));

  function logFaultsOf(figure) {
    const ticks = textsOf(figure).filter((text) => text.isOnLeft).map((text) => numberOf(text.text));
    return ticks.length >= 2 && ticks.every((tick) => tick > 0) ? [] : [`${titleOf(figure)}: its logarithmic axis says ${ticks.join(", ")}`];
  }

  /** Switches one curve after the other off: what does not change the picture was not in it. */
  async function unseen() {
    const found = [];
    const pictures = new Map(figures().map((figure) => [figure, pictureOf(figure)]));
    const keysOf = (figure) => [...figure.querySelectorAll(".key:not(.off)")];
    const hidden = [];
    while (true) {
      const keys = figures().flatMap((figure) => keysOf(figure).slice(0, 1).map((key) => [figure, key]));
      if (keys.length === 0) break;
      keys.forEach(([, key]) => key.click());
      hidden.push(...keys.map(([, key]) => key));
      await frames();
      for (const [figure, key] of keys) {
        const picture = pictureOf(figure);
        if (picture === pictures.get(figure)) found.push(`${titleOf(figure)}: ${key.textContent}`);
        pictures.set(figure, picture);
      }
    }
    hidden.forEach((key) => key.click());
    await frames();
    return found;
  }

  /** What is wrong with logarithmic axes, also with those that are linear at first. */
  async function logFaults() {
    const those = (wanted) => figures().filter((figure) => figure.querySelector(".tools button")?.getAttribute("aria-pressed") === wanted);
    const found = those("true").flatMap(logFaultsOf);
    const linear = those("false");
    const press = async () => {
      linear.forEach((figure) => figure.querySelector(".tools button").click());
      await frames();
    };
    await press();
    found.push(...linear.flatMap(logFaultsOf));
    await press();
    return found;
  }

  window.checks = {
    frames, logFaults, unseen,
    figures: () => figures().map(titleOf),
    layout: () => figures().flatMap(faultsOf),
    /** The labels at the bottom of a chart. */
    times: (title) => textsOf(figures().find((figure) => titleOf(figure) === title)).filter((text) => !text.isOnLeft).map((text) => text.text),
    /** Where a plot is in the window, to which it is brought. */
    place: (title) => {
      const plot = figures().find((figure) => titleOf(figure) === title).querySelector(".plot");
      plot.scrollIntoView({block: "center", behavior: "instant"});
      const {left, top, width, height} = plot.getBoundingClientRect();
      return {left, top, width, height};
    },
    until: async (isReached) => { while (!isReached()) await frames(1); },
  };
})();
