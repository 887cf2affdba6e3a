// What all pages have: title, sections, tables, the toolbar, dark and light.

function isDarkAtFirst() {
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

function showTheme(isDark) {
  document.documentElement.classList.toggle("dark", isDark);
  for (const chart of allCharts) drawSoon(chart);
}

function beginPage(title, subtitle) {
  document.title = title;
  document.getElementById("title").textContent = title;
  document.getElementById("subtitle").textContent = subtitle;
  showTheme(isDarkAtFirst());
}

const sections = [];

/** A section with a heading; the toolbar links to it. */
function section(id, title, note = "", shortTitle = title) {
  const made = element("section", {id}, element("h2", {textContent: title}));
  if (note) made.append(element("p", {className: "note", textContent: note}));
  document.getElementById("main").append(made);
  sections.push({id, title: shortTitle});
  return made;
}

function grid(parent, charts, isSingle = charts.length === 1) {
  const made = element("div", {className: "grid" + (isSingle ? " single" : "")});
  made.append(...charts.map((chart) => chart.figure));
  parent.append(made);
}

function cell(value, className = "") {
  return element("td", {className, textContent: value});
}

/** A table; the heads of columns of texts in `texts`. */
function tableOf(heads, texts, rows) {
  const head = element("thead", {}, element("tr", {},
    ...heads.map((name, i) => element("th", {textContent: name, className: texts.includes(i) ? "text" : ""}))));
  const made = element("table", {}, head, element("tbody", {}, ...rows.map((row) => element("tr", {}, ...row))));
  return element("div", {className: "scroll"}, made);
}

/** What a range shows of the whole, and the way back. */
function rangeTools(range) {
  const shown = element("span", {className: "range"});
  const whole = element("button", {type: "button", textContent: "whole run"});
  const back = element("button", {type: "button", textContent: "back"});
  whole.addEventListener("click", () => range.reset());
  back.addEventListener("click", () => range.back());
  const tell = () => {
    const [from, to] = range.shown;
    const digits = Math.max(1, Math.min(6, 2 - Math.floor(Math.log10(to - from))));
    const text = (time) => time.toFixed(digits).replace(/^-(0\.0*)$/, "$1").replace("-", "−");
    shown.textContent = `${text(from)} s to ${text(to)} s`;
    whole.disabled = range.isWhole;
    back.disabled = range.past.length === 0;
  };
  range.listeners.push({shown: tell});
  tell();
  return [shown, back, whole];
}

/** Links to the sections, and, where there are charts over a range, what they show of it. */
function makeToolbar(range = null) {
  const toolbar = document.getElementById("toolbar");
  for (const {id, title} of sections) toolbar.append(element("a", {href: "#" + id, textContent: title}));
  const theme = element("button", {type: "button", textContent: "dark / light"});
  theme.addEventListener("click", () => showTheme(!document.documentElement.classList.contains("dark")));
  if (range !== null) toolbar.append(...rangeTools(range));
  else theme.style.marginLeft = "auto";
  toolbar.append(theme);
  document.getElementById("main").append(element("footer"));
}
