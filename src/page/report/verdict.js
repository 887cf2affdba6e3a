// What stands on top: the verdict, and figures of each state.

function verdictSection() {
  const made = section("verdict", "Verdict");
  const findings = element("ul", {className: "findings"});
  for (const {level, text} of data.verdict) {
    findings.append(element("li", {className: level, textContent: text}));
  }
  made.append(findings);
}

/** What other gains would have done: root mean squares, and what is said of the norm. */
function besideTable() {
  const names = data.errors.map((row) => row.name);
  const heads = [...names.map((name) => `RMSE of ${name}`), "largest norm", "settled after [s]", "largest share of the bound"];
  const table = element("table", {}, element("thead", {}, element("tr", {}, element("th", {className: "text", textContent: "gains"}),
    ...heads.map((head) => element("th", {textContent: head})))));
  const body = element("tbody");
  for (const {name, errors} of [{name: "these", errors: data.errors}, ...data.beside]) {
    const norm = errors[errors.length - 1];
    const share = norm.bound ? Math.max(...errors.map((row) => row.bound.largest_share ?? 0)) : null;
    body.append(element("tr", {}, cell(name, "text"), ...errors.map((row) => cell(shortNumber(row.rmse))),
                        cell(shortNumber(norm.largest)),
                        cell(norm.settling_time === 0 ? "at once" : shortNumber(norm.settling_time)),
                        cell(share === null ? "–" : shortNumber(100 * share, 3) + " %", share > 1 ? "bad" : "")));
  }
  table.append(body);
  return element("div", {className: "scroll"}, table);
}

function errorsSection() {
  if (data.errors.length === 0) return;
  const made = section("errors", "Errors", "Over the stamps that are counted. Settled: from when on, after the first stamp "
    + "of the truth, the error stays within 5 % of its largest, or within twice its largest of the second half of the "
    + "run, where that is more.");
  const isBounded = data.errors.some((row) => row.bound);
  const isHeld = data.errors.some((row) => row.hold_rmse !== null);
  const heads = ["RMSE", ...(isHeld ? ["holding the last sample", "ratio"] : []), "largest", "settled after [s]", "within",
                 ...(isBounded ? ["bound finite at", "exceeded at", "largest share of it"] : [])];
  const table = element("table", {}, element("thead", {}, element("tr", {}, element("th", {className: "text", textContent: "state"}),
    ...heads.map((head) => element("th", {textContent: head})))));
  const body = element("tbody");
  for (const row of data.errors) {
    const ratio = row.hold_rmse > 0 ? row.rmse / row.hold_rmse : null;
    const unit = row.name === "norm" ? unitOfNorm() : run.columns.find((column) => column.name === row.name)?.unit;
    const cells = [cell(withUnit(row.name, unit), "text"), cell(shortNumber(row.rmse))];
    if (isHeld) cells.push(cell(shortNumber(row.hold_rmse)), cell(shortNumber(ratio, 3), ratio === null ? "" : ratio < 1 ? "good" : "warning"));
    cells.push(cell(shortNumber(row.largest)), cell(row.settling_time === 0 ? "at once" : shortNumber(row.settling_time)), cell(shortNumber(row.settled_within)));
    if (isBounded) {
      const {finite, exceeded, largest_share: share} = row.bound;
      cells.push(cell(`${finite} stamps`), cell(exceeded === 0 ? "none" : `${exceeded} stamps`, exceeded === 0 ? "good" : "bad"),
                 cell(share === null ? "–" : shortNumber(100 * share, 3) + " %"));
    }
    body.append(element("tr", {}, ...cells));
  }
  table.append(body);
  made.append(element("div", {className: "scroll"}, table));
  if (data.beside.length > 0) {
    made.append(element("p", {className: "note", textContent: "Beside other gains, on the same bag:"}), besideTable());
  }
}
