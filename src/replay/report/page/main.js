// The page: sections from top to bottom, the toolbar, dark and light.

function isDarkAtFirst() {
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

function showTheme(isDark) {
  document.documentElement.classList.toggle("dark", isDark);
  for (const chart of allCharts) drawSoon(chart);
}

function makeToolbar() {
  const toolbar = document.getElementById("toolbar");
  for (const {id, title} of run.sections) toolbar.append(element("a", {href: "#" + id, textContent: title}));
  const shown = element("span", {className: "range"});
  const whole = element("button", {type: "button", textContent: "whole run"});
  const back = element("button", {type: "button", textContent: "back"});
  const theme = element("button", {type: "button", textContent: "dark / light"});
  whole.addEventListener("click", () => run.range.reset());
  back.addEventListener("click", () => run.range.back());
  theme.addEventListener("click", () => showTheme(!document.documentElement.classList.contains("dark")));
  const tell = () => {
    const [from, to] = run.range.shown;
    const digits = Math.max(1, Math.min(6, 2 - Math.floor(Math.log10(to - from))));
    shown.textContent = `${from.toFixed(digits)} s to ${to.toFixed(digits)} s`;
    whole.disabled = run.range.isWhole;
    back.disabled = run.range.past.length === 0;
  };
  run.range.listeners.push({shown: tell});
  tell();
  toolbar.append(shown, back, whole, theme);
}

document.title = `${data.bag}: ${data.observer}`;
document.getElementById("title").textContent = `${data.observer} on ${data.bag}`;
document.getElementById("subtitle").textContent =
  `Replay report. Times are in seconds after ${data.origin.toFixed(3)} s.`;
showTheme(isDarkAtFirst());
prepareRun();
verdictSection();
errorsSection();
statesSection();
normSection();
lyapunovSection();
pathSection();
hybridSection();
innovationsSection();
intervalsSection();
delaysSection();
eventsSection();
configurationSection();
makeToolbar();
document.getElementById("main").append(element("footer"));
