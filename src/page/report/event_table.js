// The events, in pages, and filters on them.

const ROWS = 100;  // on a page
const KIND_NAMES = {[KIND.input]: "input", [KIND.jump]: "jump", [KIND.jumpOutput]: "output at a jump",
                    [KIND.output]: "output", [KIND.sample]: "sample", [KIND.withdrawal]: "withdrawal"};
const CHECK_NAMES = ["", "", "below T1", "above T2"];

class EventTable {
  constructor(parent) {
    this.parent = parent;
    this.page = 0;
    const {events} = run;
    const choice = (label, entries) => {
      const select = element("select", {ariaLabel: label}, element("option", {value: "", textContent: label}),
        ...entries.map(([value, text]) => element("option", {value: String(value), textContent: text})));
      select.addEventListener("change", () => this.filter());
      return select;
    };
    const counts = new Map();
    for (const outcome of events.outcome) counts.set(outcome, (counts.get(outcome) ?? 0) + 1);
    this.source = choice("all sources", events.sources.map((name, i) => [i, name]));
    this.outcome = choice("all outcomes", [...counts].sort((a, b) => a[0] - b[0])
      .map(([outcome, count]) => [outcome, `${events.outcomes_in_words[outcome]} (${count})`]));
    this.search = element("input", {type: "search", placeholder: "reason contains", ariaLabel: "reason contains"});
    this.search.addEventListener("input", () => this.filter());
    const box = (text) => {
      const input = element("input", {type: "checkbox"});
      input.addEventListener("change", () => this.filter());
      return {input, label: element("label", {}, input, " " + text)};
    };
    this.unusual = box("late, rejected or outside [T1, T2] only");
    this.inSight = box("in the span shown only");
    this.count = element("span", {className: "note"});
    this.previous = element("button", {type: "button", textContent: "‹", ariaLabel: "previous page"});
    this.next = element("button", {type: "button", textContent: "›", ariaLabel: "next page"});
    this.previous.addEventListener("click", () => this.show(this.page - 1));
    this.next.addEventListener("click", () => this.show(this.page + 1));
    this.body = element("tbody");
    const heads = ["arrival [s]", "stamp [s]", "source", "kind", "outcome", "latency [s]", "interval [s]", "", "rewound", "innovation"];
    const isText = [false, false, true, true, true];
    const table = element("table", {}, element("thead", {}, element("tr", {},
      ...heads.map((head, i) => element("th", {textContent: head, className: isText[i] ? "text" : ""})))), this.body);
    parent.append(element("div", {className: "filters"}, this.source, this.outcome, this.search, this.unusual.label,
                          this.inSight.label, this.previous, this.next, this.count),
                  element("div", {className: "scroll events"}, table));
    run.range.listeners.push({shown: () => { if (this.inSight.input.checked) this.filter(); }});
    this.filter();
  }

  filter() {
    const {events} = run;
    const [source, outcome] = [this.source.value, this.outcome.value];
    const text = this.search.value.toLowerCase();
    const reasons = events.reasons.map((reason) => reason.toLowerCase().includes(text));
    const [from, to] = this.inSight.input.checked ? run.range.shown : [-Infinity, Infinity];
    this.rows = [];
    for (let i = 0; i < events.arrival.length; ++i) {
      const isUnusual = events.outcome[i] !== OUTCOME.used || events.check[i] > 1;
      if ((source === "" || events.source[i] === Number(source)) && (outcome === "" || events.outcome[i] === Number(outcome))
          && reasons[events.reason[i]] && (isUnusual || !this.unusual.input.checked)
          && events.arrival[i] >= from && events.arrival[i] <= to) {
        this.rows.push(i);
      }
    }
    this.show(0);
  }

  show(page) {
    const pages = Math.max(1, Math.ceil(this.rows.length / ROWS));
    this.page = Math.max(0, Math.min(pages - 1, page));
    this.previous.disabled = this.page === 0;
    this.next.disabled = this.page === pages - 1;
    const leftOut = data.events.left_out;
    this.count.textContent = `${this.rows.length} of ${run.events.arrival.length} events, page ${this.page + 1} of ${pages}`
      + (leftOut > 0 ? `; ${leftOut} more, used as they should be, are left out` : "");
    this.body.replaceChildren(...this.rows.slice(this.page * ROWS, (this.page + 1) * ROWS).map((i) => this.row(i)));
  }

  row(i) {
    const {events} = run;
    const stamp = events.arrival[i] - events.latency[i];
    const isUsed = events.outcome[i] === OUTCOME.used || events.outcome[i] === OUTCOME.usedLate;
    const time = (value) => value.toFixed(4).replace("-", "−");
    const row = element("tr", {title: "show its time"},
      cell(time(events.arrival[i])), cell(Math.abs(stamp) < 1e8 ? time(stamp) : "–"),
      cell(events.sources[events.source[i]], "text"), cell(KIND_NAMES[events.kind[i]] ?? "", "text"),
      cell(events.reasons[events.reason[i]], "text wide " + (isUsed ? "" : "warning")),
      cell(shortNumber(events.latency[i])), cell(shortNumber(events.interval[i])),
      cell(CHECK_NAMES[events.check[i]], "text warning"), cell(events.rewound[i] || ""), cell(shortNumber(events.innovation[i])));
    row.addEventListener("click", () => {
      const half = Math.max(0.5, 0.01 * (run.range.whole[1] - run.range.whole[0]));
      run.range.show(events.arrival[i] - half, events.arrival[i] + half);
      run.range.point(events.arrival[i]);
    });
    return row;
  }
}

function eventsSection() {
  if (run.events.arrival.length === 0) return;
  new EventTable(section("events", "Events", "What became of each message, in the order of arrival. A click shows its time in the charts."));
}
