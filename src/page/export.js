// A figure as a picture of its own: what is shown, with its title and its keys above.

const HEAD = 34;  // pixels above the plot, for title and keys in one row
const ROW = 18;   // pixels for each further row of keys

/** Writes down as SVG what is drawn with the part of a canvas' context that figures use. */
class SvgContext {
  constructor(font) {
    Object.assign(this, {font, fillStyle: "#000", strokeStyle: "#000", lineWidth: 1, lineJoin: "miter", globalAlpha: 1,
                         textAlign: "left", textBaseline: "alphabetic", parts: [], path: "", dash: [], open: [0], clips: 0});
    this.ruler = element("canvas").getContext("2d");
  }

  static number(value) {
    return Number.isFinite(value) ? String(Math.round(value * 100) / 100) : "0";
  }

  static escaped(text) {
    return String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;");
  }

  beginPath() { this.path = ""; }
  at(letter, ...values) { this.path += letter + values.map(SvgContext.number).join(" "); }
  moveTo(x, y) { this.at("M", x, y); }
  lineTo(x, y) { this.at(this.path === "" ? "M" : "L", x, y); }
  rect(x, y, width, height) { this.at("M", x, y); this.path += `h${width}v${height}h${-width}z`; }
  arc(x, y, radius) {  // whole circles only
    this.at("M", x - radius, y);
    const half = SvgContext.number(radius);
    this.path += `a${half} ${half} 0 1 0 ${2 * half} 0a${half} ${half} 0 1 0 ${-2 * half} 0`;
  }
  setLineDash(dash) { this.dash = dash; }
  translate(x, y) { this.begin(`<g transform="translate(${x} ${y})">`); }
  measureText(text) {
    this.ruler.font = this.font;
    return this.ruler.measureText(text);
  }

  begin(tag) {
    this.parts.push(tag);
    ++this.open[this.open.length - 1];
  }
  save() { this.open.push(0); }
  restore() { this.parts.push("</g>".repeat(this.open.pop())); }
  clip() {
    const id = "clip" + this.clips++;
    this.parts.push(`<clipPath id="${id}"><path d="${this.path}"/></clipPath>`);
    this.begin(`<g clip-path="url(#${id})">`);
  }

  stroke() {
    const dash = this.dash.length > 0 ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.parts.push(`<path d="${this.path}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}"`
      + ` stroke-linejoin="${this.lineJoin}" opacity="${this.globalAlpha}"${dash}/>`);
  }
  fill() { this.parts.push(`<path d="${this.path}" fill="${this.fillStyle}" opacity="${this.globalAlpha}"/>`); }
  fillRect(x, y, width, height) {
    this.beginPath();
    this.rect(...[x, y, width, height].map(SvgContext.number).map(Number));
    this.fill();
  }
  strokeRect(x, y, width, height) {
    this.beginPath();
    this.rect(x, y, width, height);
    this.stroke();
  }
  fillText(text, x, y) {
    const anchor = {left: "start", center: "middle", right: "end"}[this.textAlign];
    const drop = {top: 0.8, middle: 0.35, alphabetic: 0}[this.textBaseline];
    this.parts.push(`<text x="${SvgContext.number(x)}" y="${SvgContext.number(y)}" dy="${drop}em" text-anchor="${anchor}"`
      + ` fill="${this.fillStyle}">${SvgContext.escaped(text)}</text>`);
  }

  text(width, height) {
    const size = parseFloat(this.font.match(/[0-9.]+px/)[0]);
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}"`
      + ` font-family="system-ui, sans-serif" font-size="${size}">`
      + this.parts.join("") + "</g>".repeat(this.open[0]) + "</svg>";
  }
}

const SWATCH = 17;
const GAP = 14;

/** Where the title and the shown keys of a figure stand, in rows that are no wider than the plot, and how high these are. */
function headOf(figure, context, width) {
  const entries = [{text: figure.title, layer: null},
                   ...figure.keys.filter((each) => !each.isHidden).map((layer) => ({text: layer.label, layer}))];
  let x = 12;
  let row = 0;
  for (const entry of entries) {
    const length = (entry.layer ? SWATCH : 0) + context.measureText(entry.text).width;
    if (x > 12 && x + length > width - 12) {
      x = 12;
      ++row;
    }
    Object.assign(entry, {x, y: HEAD / 2 + row * ROW});
    x += length + GAP;
  }
  return {entries, height: HEAD + row * ROW};
}

/** Draws a figure below its head on a context. */
function drawSheet(figure, context, width, height, head) {
  context.fillStyle = colour("panel");
  context.fillRect(0, 0, width, height + head.height);
  context.textAlign = "left";
  context.textBaseline = "middle";
  for (const {text, layer, x, y} of head.entries) {
    if (layer) {
      context.fillStyle = colour(layer.colour);
      context.globalAlpha = ["band", "interval"].includes(layer.kind) ? 0.35 : 1;
      context.fillRect(x, y - 4, 12, 8);
      context.globalAlpha = 1;
    }
    context.fillStyle = colour(layer ? "muted" : "text");
    context.fillText(text, x + (layer ? SWATCH : 0), y);
  }
  context.translate(0, head.height);
  figure.sheet = {context, width, height};
  figure.draw();
  figure.sheet = null;
}

/** An address of the picture, as PNG of twice the size on the screen, or as SVG. */
function pictureOf(figure, kind) {
  const {clientWidth: width, clientHeight: height} = figure.plot;
  const font = "12px system-ui, 'DejaVu Sans', sans-serif";
  if (kind === "svg") {
    const context = new SvgContext(font);
    const head = headOf(figure, context, width);
    drawSheet(figure, context, width, height, head);
    return "data:image/svg+xml;charset=utf-8," + encodeURIComponent(context.text(width, height + head.height));
  }
  const canvas = element("canvas");
  const context = canvas.getContext("2d");
  context.font = font;
  const head = headOf(figure, context, width);
  Object.assign(canvas, {width: 2 * width, height: 2 * (height + head.height)});  // which resets the context
  context.scale(2, 2);
  context.font = font;
  drawSheet(figure, context, width, height, head);
  return canvas.toDataURL("image/png");
}

/** Over the plot, so that they take no room while they are not seen. */
function exportButtons(figure) {
  const buttons = ["png", "svg"].map((kind) => {
    const button = element("button", {type: "button", textContent: kind.toUpperCase(), className: "export",
                                      title: "save what is shown as a picture"});
    button.addEventListener("click", () => {
      const name = figure.title.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_|_$/g, "");
      element("a", {href: pictureOf(figure, kind), download: `${name}.${kind}`}).click();
    });
    return button;
  });
  const made = element("span", {className: "exports"}, ...buttons);
  // What begins here is no drag of the plot.
  for (const kind of ["pointerdown", "dblclick"]) made.addEventListener(kind, (event) => event.stopPropagation());
  return made;
}
