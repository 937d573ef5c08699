// The results: filtered, sorted, and a row's bounds on demand. The address holds the filters, so
// that a view can be passed on.

const columns = data.columns;
const count = data.cases.length ? (columns.case ?? []).length : 0;
const verdictOf = (i) => (columns.verdict[i]);
const fineness = (i) => columns.tolerance?.[i] ?? columns.step?.[i] ?? 0;
const value = (name) => (i) => columns[name]?.[i] ?? null;

// Key, heading, what it means, figure of a row, text of it where that is another.
const SHOWN = [
  ["case", "case", "the problem that is run", value("case")],
  ["engine", "engine", "the integrator", value("engine")],
  ["setting", "setting", "relative and absolute tolerance, or h = fixed step", fineness, value("setting")],
  ["verdict", "verdict", "the first that applies of unavailable, not-run, error, fail, known, undecidable, not-scored, pass", (i) => ["error", "fail", "known", "undecidable", "not-scored", "pass", "not-run", "unavailable"].indexOf(verdictOf(i)), verdictOf],
  ["found", "found", "events found, of those that the truth has up to the scored horizon", (i) => (columns.events_matched?.[i] ?? -1) - (columns.events_expected?.[i] ?? 0), (i) => (columns.events_expected?.[i] == null ? "–" : `${columns.events_matched[i]}/${columns.events_expected[i]}`)],
  ["events_spurious", "spurious", "events that the truth does not have", value("events_spurious")],
  ["event_time_error.max", "time error", "largest error of an event's time", value("event_time_error.max")],
  ["state_error.max", "state error", `${data.state_error} on the fixed sample`, value("state_error.max")],
  ["drift_error", "drift error", "|dv| at the end of the case", value("drift_error")],
  ["valid_periods", "valid", "forcing periods until the state's error passes 1e-3", value("valid_periods")],
  ["restart.q99", "restart q99", "99 % quantile of the restart test's errors", value("restart.q99")],
  ["order", "order", "measured order of convergence", value("order")],
  ["rhs_evaluations", "rhs", "right-hand sides; closed-form evaluations for the exact solver", value("rhs_evaluations")],
  ["jacobian_evaluations", "jac", "Jacobians, or products with one", value("jacobian_evaluations")],
  ["linear_solves", "solves", "linear systems solved", value("linear_solves")],
  ["wall_ns", "ms", "wall time on this machine, milliseconds", (i) => (columns.wall_ns?.[i] == null ? null : columns.wall_ns[i] / 1e6)],
].filter(([key]) => ["found", "verdict", "setting"].includes(key) || columns[key]);

const PAGE = 100;
const state = { engine: "", case: "", verdict: "", text: "", sort: "", down: false, most: PAGE };
const field = (name) => document.getElementById(`filter-${name}`);
const FILTERS = ["engine", "case", "verdict", "text"];

function fillChoices() {
  const regimes = new Map();
  const regimeOf = (it) => it.regime || "cases";
  data.cases.forEach((it) => regimes.set(regimeOf(it), [...(regimes.get(regimeOf(it)) ?? []), it.name]));
  for (const [regime, names] of regimes) field("case").append(element("optgroup", { label: regime }, ...names.map((name) => element("option", { value: name }, name))));
  data.engines.forEach((it) => field("engine").append(element("option", { value: it.name }, it.name)));
}

function wanted(i) {
  const note = () => data.cases.find((it) => it.name === columns.case[i]);
  const trouble = () => (note()?.trouble ?? []).map((kind) => `trouble:${kind} `).join("");
  const text = () => [columns.case[i], columns.engine[i], columns.setting[i], verdictOf(i), columns.why[i], note()?.regime, trouble()].join(" ").toLowerCase();
  return (!state.engine || columns.engine[i] === state.engine) &&
    (!state.case || columns.case[i] === state.case) &&
    (!state.verdict || verdictOf(i) === state.verdict) &&
    (!state.text || state.text.toLowerCase().split(/\s+/).every((word) => text().includes(word)));
}

function ordered(rows) {
  const column = SHOWN.find(([key]) => key === state.sort);
  if (!column) return rows;
  const figure = column[3];
  const compare = (a, b) => {
    const [x, y] = [figure(a), figure(b)];
    // What was not measured comes last, either way.
    if (x === null || y === null) return (x === null) - (y === null);
    const order = typeof x === "string" ? x.localeCompare(y, "en", { numeric: true }) : x - y;
    return state.down ? -order : order;
  };
  return [...rows].sort(compare);
}

function details(i) {
  const bounds = data.bounds[i].map(([what, limit, measured, verdict, why]) =>
    element("tr", {}, element("td", {}, data.texts[what]), element("td", { class: "number" }, brief(measured)), element("td", { class: "number" }, brief(limit)), element("td", {}, element("span", { class: `pill ${data.texts[verdict]}` }, data.texts[verdict])), element("td", { class: "why" }, data.texts[why])));
  const rest = Object.keys(columns).filter((key) => !["case", "engine", "setting", "verdict", "why", "expected", "status", "tolerance", "step"].includes(key) && columns[key][i] !== null);
  const note = data.cases.find((it) => it.name === columns.case[i]);
  const [above, parts] = [[], []];
  if (columns.why[i]) above.push(element("p", {}, columns.why[i]));
  const picture = eventPicture(i);
  if (picture) above.push(picture);
  else if (columns.events_missed?.[i] > 0 || columns.events_spurious?.[i] > 0) above.push(element("p", { class: "muted" }, "This page has no picture of this row: the command below with --out DIR draws it."));
  if (note?.why) parts.push(element("p", { class: "muted" }, `About the case${note.regime ? ` (${note.regime})` : ""}: ${note.why}`));
  if (bounds.length) parts.push(element("div", { class: "wide" }, element("table", { class: "inner" }, element("thead", {}, element("tr", {}, ...["bound on", "measured", "limit", "", "why that limit"].map((it) => element("th", {}, it)))), element("tbody", {}, ...bounds))));
  const figure = (key) => [element("dt", {}, inWords(key)), element("dd", {}, brief(columns[key][i]))];
  parts.push(element("dl", { class: "figures" }, ...rest.flatMap(figure)));
  const sides = element("div", { class: "sides" }, element("div", {}, ...parts), repeat(i, note));
  const made = element("tr", { class: "details" }, element("td", { colspan: SHOWN.length }, element("div", {}, ...[...above, sides])));
  made.show = () => picture?.show();
  return made;
}

// The command that makes a row again, and the case as it is written.
function repeat(i, note) {
  const engine = data.engines.find((it) => it.name === columns.engine[i]);
  // A line ends between the parts of a command, never inside one.
  const chosen = data.verb === "validate" ? [`-e ${engine?.pattern}`] : [];
  const words = [`percuss ${data.verb}`, `-c ${note?.pattern}`, ...chosen, ...data.repeat.split(" --").map((it, k) => (k ? `--${it}` : it))];
  const parts = [element("h4", {}, "Repeat this row"), element("pre", { class: "command" }, ...words.flatMap((it) => [element("span", {}, it), " "]))];
  if (note?.toml) parts.push(element("h4", {}, "The case"), element("pre", {}, note.toml));
  return element("div", { class: "repeat" }, ...parts);
}

// A figure's name for people.
const WORDS = {
  events_expected: "events of the truth", events_matched: "found", events_missed: "missed", events_spurious: "spurious",
  event_time_error: "error of event times", state_error: "error of the state", drift_error: "error of the drift",
  drift_error_by_event_times: "drift error that event times explain", horizon_periods: "scored horizon (forcing periods)",
  phase_word_ok: "phases or modes in the right order", valid_periods: "valid (forcing periods)", valid_horizon: "valid horizon",
  predicted_median: "predicted median", q01: "1 % quantile", q99: "99 % quantile", max: "largest", with_impact: "with an impact",
  order: "order of convergence", rhs_evaluations: "right-hand sides", jacobian_evaluations: "Jacobians", linear_solves: "linear solves",
  ks_p: "Kolmogorov-Smirnov distance of p", ks_y: "Kolmogorov-Smirnov distance of y", ks_q: "Kolmogorov-Smirnov distance of q",
  ks_p_sum: "Kolmogorov-Smirnov distance of sums of successive p", ks_p_step: "Kolmogorov-Smirnov distance of differences of successive p",
  ks_y_sum: "Kolmogorov-Smirnov distance of sums of successive y", ks_y_step: "Kolmogorov-Smirnov distance of differences of successive y",
  wasserstein_p: "Wasserstein distance of p", wasserstein_y: "Wasserstein distance of y", wasserstein_q: "Wasserstein distance of q",
  wasserstein_p_sum: "Wasserstein distance of sums of successive p", wasserstein_p_step: "Wasserstein distance of differences of successive p",
  wasserstein_y_sum: "Wasserstein distance of sums of successive y", wasserstein_y_step: "Wasserstein distance of differences of successive y",
  phase_words: "frequencies of phase sequences", lyapunov: "Lyapunov exponent", drift: "mean drift",
  map_error_median: "median error of a period", map_error_share: "share of periods with a large error",
  wall_ns: "nanoseconds", restart: "restart test", distance: "distance of attractors",
};
const inWords = (key) => key.split(".").map((part) => WORDS[part] ?? part.replaceAll("_", " ")).join(", ");

function rowOf(i) {
  const cells = SHOWN.map(([key, , , figure, text]) => {
    if (key === "verdict") return element("td", {}, element("span", { class: `pill ${verdictOf(i)}` }, verdictOf(i)));
    if (key === "engine") return element("td", {}, element("span", { class: "dot", style: `background:${colour(columns.engine[i])}` }), columns.engine[i]);
    const plain = key === "case";
    const off = (key === "found" && columns.events_missed?.[i] > 0) || (key === "events_spurious" && figure(i) > 0);
    return element("td", { class: plain ? "name" : `number${off ? " off" : ""}` }, text ? text(i) : plain ? figure(i) : brief(figure(i)));
  });
  const row = element("tr", { tabindex: 0, class: "row", "aria-expanded": "false" }, ...cells);
  const toggle = () => {
    const open = row.getAttribute("aria-expanded") === "true";
    row.setAttribute("aria-expanded", String(!open));
    if (open) row.nextSibling.remove();
    else {
      row.after(details(i));
      row.nextSibling.show();
    }
  };
  row.addEventListener("click", toggle);
  row.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      toggle();
    }
  });
  return row;
}

function showRows() {
  const rows = ordered([...Array(count).keys()].filter(wanted));
  const head = SHOWN.map(([key, heading, title]) => element("th", { title, scope: "col", "aria-sort": state.sort === key ? (state.down ? "descending" : "ascending") : "none" },
    element("button", { type: "button", onclick: () => {
      state.down = state.sort === key && !state.down;
      state.sort = key;
      showRows();
    } }, heading)));
  document.getElementById("rows-head").replaceChildren(...head);
  document.getElementById("rows-body").replaceChildren(...rows.slice(0, state.most).map(rowOf));
  document.getElementById("rows-count").textContent = `${brief(rows.length)} of ${brief(count)} rows`;
  const more = document.getElementById("rows-more");
  more.hidden = rows.length <= state.most;
  more.textContent = `show all ${brief(rows.length)} rows`;
  const address = new URLSearchParams(FILTERS.filter((name) => state[name]).map((name) => [name, state[name]]));
  history.replaceState(null, "", address.size ? `#${address}` : location.pathname + location.search);
}

function readAddress() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const name of FILTERS) {
    state[name] = given.get(name) ?? "";
    field(name).value = state[name];
    // A choice that there is not is no choice.
    if (field(name).value !== state[name]) state[name] = field(name).value = "";
  }
}

// Shows the rows that a link stands for.
function filterBy(choices) {
  for (const name of FILTERS) state[name] = field(name).value = choices[name] ?? "";
  Object.assign(state, { sort: "", down: false, most: PAGE });
  showRows();
}

function startRows() {
  fillChoices();
  // A link to a section is no filter.
  if (location.hash.includes("=")) readAddress();
  for (const name of FILTERS) {
    field(name).addEventListener("input", () => {
      state[name] = field(name).value;
      state.most = PAGE;
      showRows();
    });
  }
  document.getElementById("filter-clear").addEventListener("click", () => {
    filterBy({});
  });
  document.getElementById("rows-more").addEventListener("click", () => {
    state.most = Infinity;
    showRows();
  });
  showRows();
}

// What a row holds stays as wide as what is seen of the table.
const measureTable = () => {
  document.getElementById("results").style.setProperty("--seen", `${document.querySelector("#results .scroll").clientWidth}px`);
  redrawAll();
};
window.addEventListener("resize", measureTable);
measureTable();
if (count) startRows();
