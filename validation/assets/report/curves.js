// Work-precision, error growth, and the restart test.

const hidden = new Set();

function legendOf(host, names, redraw) {
  host.replaceChildren(...names.map((name) => {
    const sample = drawn("svg", { width: 16, height: 12, viewBox: "-8 -6 16 12", "aria-hidden": "true" });
    sample.append(markerOf(marker(name), [0, 0], colour(name)));
    return element("button", { type: "button", "aria-pressed": String(!hidden.has(name)), onclick: () => {
      hidden.has(name) ? hidden.delete(name) : hidden.add(name);
      redraw();
    } }, sample, name);
  }));
}

// Whether a row's errors are over all events of the truth, and it has no others.
const isOfAllEvents = (i) => columns.events_matched?.[i] === columns.events_total?.[i] && !columns.events_spurious?.[i];
const eventsOf = (i) => `${columns.events_matched?.[i] ?? 0} of ${columns.events_total?.[i]} events${columns.events_spurious?.[i] ? `, ${columns.events_spurious[i]} spurious` : ""}`;

// What the points are over, and which of them are hollow.
function workNote(note) {
  if (note) return `${note.regime ? `${note.regime}. ` : ""}${note.why ?? ""} Hollow, not joined: runs with missed or spurious events, or that are scored for a part of the truth's events only.`;
  const apart = data.engines.flatMap((engine) => (engine.settings ?? []).filter((it) => it.runs && !it.is_comparable).map((it) => `${engine.name} ${it.setting} (${it.of})`));
  const only = data.cases.length === 1;
  const why = only ? "these runs have missed or spurious events, or are scored for a part of the truth's events only" : "fewer than nine tenths of their rows were run, so that these medians are over other cases";
  const hollow = apart.length ? ` Hollow, not joined: ${why}: ${apart.join(", ")}.` : "";
  const first = only ? "Each point is a run's largest error against its cost." : "Each point is the median over the cases of a run's largest error, against the median cost of a run; a run without a result, and for event times one that has a missed or a spurious event, counts as infinitely wrong.";
  return first + hollow;
}

function workPrecision() {
  const choice = document.getElementById("work-case");
  const work = document.getElementById("work-x");
  const hosts = [["work-time", "time", "event_time_error.max", "event-time error"], ["work-state", "state", "state_error.max", "state error"]];
  const points = (engine, chosen, key, kind) => {
    if (!chosen) return (engine.settings ?? []).map((it) => [work.value === "rhs" ? it.rhs : it.ns / 1e6, it[`${kind}_error`], `${it.setting} (${it.of})`, !it.is_comparable]);
    const rows = [...Array(count).keys()].filter((i) => columns.case[i] === chosen && columns.engine[i] === engine.name);
    rows.sort((a, b) => fineness(b) - fineness(a));
    return rows.map((i) => [work.value === "rhs" ? columns.rhs_evaluations?.[i] : columns.wall_ns?.[i] / 1e6, columns[key]?.[i], `${columns.setting[i]} (${eventsOf(i)})`, !isOfAllEvents(i)]);
  };
  const draw = () => {
    legendOf(document.getElementById("work-legend"), data.engines.map((it) => it.name), draw);
    for (const [host, kind, key, label] of hosts) {
      const series = data.engines.filter((it) => !hidden.has(it.name)).map((engine) => ({
        name: engine.name,
        color: colour(engine.name),
        marker: marker(engine.name),
        points: points(engine, choice.value, key, kind).filter((p) => p[0] > 0 && p[1] !== null && p[1] !== undefined),
      }));
      chart(document.getElementById(host), {
        x: { label: work.value === "rhs" ? "right-hand sides" : "milliseconds", log: true },
        y: { label, log: true },
        series: series.filter((s) => s.points.length),
      });
    }
    const note = data.cases.find((it) => it.name === choice.value);
    document.getElementById("work-note").textContent = workNote(note);
  };
  data.cases.forEach((it) => choice.append(element("option", { value: it.name }, it.name)));
  [choice, work].forEach((it) => it.addEventListener("input", draw));
  draw();
}

const distinct = (values) => [...new Set(values)];
const withSetting = (it) => it.engine + (it.tolerance === null ? "" : ` ${it.tolerance.toExponential().replace("e+", "e")}`);
// The finer a tolerance, the more of its line is drawn; without one it is whole.
const DASHES = ["1.5 4", "10 4 2 4", "8 3"];
const dashOf = (tolerance, all) => (tolerance === null ? "none" : DASHES[all.indexOf(tolerance) % DASHES.length]);

function errorGrowth() {
  const choice = document.getElementById("growth-case");
  if (!choice) return;
  distinct(data.growth.map((it) => it.case)).forEach((name) => choice.append(element("option", { value: name }, name)));
  const draw = () => {
    const here = data.growth.filter((it) => it.case === choice.value);
    const series = [];
    const tolerances = distinct(here.map((it) => it.tolerance).filter((it) => it !== null)).sort((a, b) => b - a);
    for (const name of distinct(here.map((it) => it.engine))) {
      here.filter((it) => it.engine === name).sort((a, b) => b.tolerance - a.tolerance).forEach((it) => {
        series.push({ name: withSetting(it), color: colour(name), dash: dashOf(it.tolerance, tolerances), points: it.periods.map((t, i) => [t, it.error[i]]).filter((p) => p[1] > 0) });
      });
    }
    // The truth's own growth stands once for each unit of error.
    const units = distinct(here.map((it) => it.tolerance));
    for (const unit of units) {
      // Of an engine whose unit of error is the tolerance itself: its line begins lowest.
      const own = here.filter((other) => other.tolerance === unit);
      const it = own.reduce((a, b) => ((b.truth_growth[0] ?? Infinity) < (a.truth_growth[0] ?? Infinity) ? b : a));
      series.push({ name: `growth of the truth × ${unit === null ? "eps" : unit.toExponential().replace("e+", "e")}`, color: "var(--muted)", width: 1.2, points: it.periods.map((t, i) => [t, it.truth_growth[i]]).filter((p) => p[1] > 0) });
    }
    const known = here.find((it) => it.lambda_per_period !== null && it.periods.length > 1);
    if (known) {
      const floor = Math.min(...here.flatMap((it) => it.error.filter((e) => e > 0)));
      const end = Math.max(...here.flatMap((it) => it.periods));
      const last = Math.min(end, Math.log(1 / floor) / Math.max(known.lambda_per_period, 1e-9));
      series.push({ name: "exp(λt)", color: "var(--ink)", dash: "3 4", width: 2, points: [[0, floor], [last, floor * Math.exp(known.lambda_per_period * last)]] });
    }
    chart(document.getElementById("growth"), { x: { label: "forcing periods", low: 0 }, y: { label: "state error", log: true }, series, height: 420 });
    // The grey lines are one thing in the key.
    const key = series.filter((s, i) => s.color !== "var(--muted)" || i === series.findIndex((other) => other.color === s.color));
    document.getElementById("growth-legend").replaceChildren(...key.map((s) => {
      const sample = drawn("svg", { width: 40, height: 10, "aria-hidden": "true" });
      sample.append(drawn("path", { d: "M1,5H39", style: `stroke:${s.color}`, "stroke-width": 2.2, "stroke-dasharray": s.dash ?? "none" }));
      return element("span", {}, sample, s.color === "var(--muted)" ? "growth of the truth × unit of error" : s.name);
    }));
    document.getElementById("growth-note").textContent = known ? `λ = ${brief(known.lambda_per_period)} per forcing period.` : "";
  };
  choice.addEventListener("input", draw);
  draw();
}

// A strip of bars for each engine and tolerance on one axis of log10(error).
function strips(rows, width) {
  // Names stand beside the strips, or above them where there is no room.
  const narrow = width < 640;
  const [label, right, tall, pad] = [narrow ? 12 : 280, 12, narrow ? 46 : 30, 26];
  const w = width - label - right;
  const filled = rows.flatMap((it) => it.counts.flatMap((n, i) => (n > 0 ? [it.edges[i], it.edges[i + 1]] : []))).filter(Number.isFinite);
  const axis = axisOver(filled.map((edge) => 10 ** edge), { log: true });
  const height = rows.length * tall + pad + 24;
  const svg = drawn("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "distribution of restart errors" });
  if (!axis) return element("p", { class: "empty" }, "No run had an error to count.");
  for (const [share, text] of axis.ticks) {
    const x = label + w * share;
    svg.append(drawn("line", { class: "grid", x1: x, x2: x, y1: 0, y2: rows.length * tall }));
    svg.append(drawn("text", { x, y: rows.length * tall + 18, "text-anchor": "middle" }, text));
  }
  rows.forEach((it, k) => {
    const [base, most, total] = [(k + 1) * tall, Math.max(...it.counts, 1), it.counts.reduce((a, b) => a + b, 0)];
    svg.append(drawn("line", { class: "grid", x1: label, x2: label + w, y1: base, y2: base }));
    svg.append(drawn("text", narrow ? { x: 0, y: base - 30 } : { x: label - 8, y: base - 8, "text-anchor": "end" }, withSetting(it)));
    it.counts.forEach((n, i) => {
      const [from, to] = [axis.place(10 ** it.edges[i]), axis.place(10 ** it.edges[i + 1])];
      if (!(n > 0) || !Number.isFinite(from) || !Number.isFinite(to)) return;
      const tallness = Math.max(1, 24 * (n / most));
      const bar = drawn("rect", { x: label + w * from, y: base - tallness, width: Math.max(1, w * (to - from) - 0.5), height: tallness, style: `fill:${colour(it.engine)}` });
      bar.append(drawn("title", {}, `${withSetting(it)}: ${n} of ${total} runs between 1e${it.edges[i]} and 1e${it.edges[i + 1]}`));
      svg.append(bar);
    });
  });
  svg.append(drawn("text", { x: label + w / 2, y: height - 4, "text-anchor": "middle", class: "axis" }, `error in units of ${rows[0].unit.replaceAll(" x ", " × ")}`));
  return svg;
}

function restarts() {
  const choice = document.getElementById("restart-case");
  if (!choice) return;
  distinct(data.restarts.map((it) => it.case)).forEach((name) => choice.append(element("option", { value: name }, name)));
  const host = document.getElementById("restart");
  host.redraw = () => {
    const here = data.restarts.filter((it) => it.case === choice.value);
    host.replaceChildren(...distinct(here.map((it) => it.unit)).map((unit) => strips(here.filter((it) => it.unit === unit), Math.max(280, host.clientWidth))));
  };
  choice.addEventListener("input", host.redraw);
  host.redraw();
}

if (count) workPrecision();
errorGrowth();
restarts();
