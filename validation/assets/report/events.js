// The first missed or spurious event of a row: its guard against time, truth and engine.

const PHASES = {
  "no-contact": ["no contact", "#0072b2", "#ffffff"],
  contact: ["contact", "#e69f00", "#1b1f24"],
  progression: ["progression", "#a01450", "#ffffff"],
};

// Modes of other systems, by their places, with the ink of their names.
const MODES = [["#0072b2", "#ffffff"], ["#e69f00", "#1b1f24"], ["#a01450", "#ffffff"], ["#00785a", "#ffffff"], ["#56b4e9", "#1b1f24"], ["#d55e00", "#ffffff"], ["#cc79a7", "#1b1f24"], ["#646464", "#ffffff"]];

// A phase or a mode as it is shown: its name, its colour, and that of its name.
function stageOf(modes, name) {
  const place = modes.indexOf(name);
  return place >= 0 ? [name, ...MODES[place % MODES.length]] : (PHASES[name] ?? [name, "var(--muted)", "var(--paper)"]);
}

// Where the root finder looked: open, and large enough to show around the end of a step.
const LOOK = "M0,-6L6,0L0,6L-6,0Z";

// A power of ten that makes numbers of this size readable; none where they are so anyway.
function factorOf(values) {
  const largest = Math.max(...values.map(Math.abs).filter(Number.isFinite), 0);
  const exponent = largest > 0 ? Math.floor(Math.log10(largest)) : 0;
  return exponent < -1 || exponent > 3 ? exponent : 0;
}

const withFactor = (label, exponent) => (exponent ? `${label}, in ${powerOfTen(exponent)}` : label);

// Where a curve of values evenly spread over a view stands at an instant.
function along(view, values, t) {
  const place = ((t - view.from) / (view.to - view.from)) * (values.length - 1);
  const k = Math.min(Math.max(Math.floor(place), 0), values.length - 2);
  return values[k] + (place - k) * (values[k + 1] - values[k]);
}

// Phases or modes as a band: the one that holds at the left edge, and those that begin in the view.
function band(svg, modes, trajectory, [left, top, width, height], place) {
  const begins = [{ t: -Infinity, phase: trajectory.phase }, ...trajectory.events];
  begins.forEach((it, k) => {
    const from = Math.max(left, place(it.t));
    const to = k + 1 < begins.length ? place(begins[k + 1].t) : left + width;
    const [name, fill, ink] = stageOf(modes, it.phase);
    const part = drawn("rect", { x: from, y: top, width: Math.max(to - from, 1), height, style: `fill:${fill}` });
    part.append(drawn("title", {}, name));
    svg.append(part);
    if (to - from > 7.2 * name.length) svg.append(drawn("text", { x: (from + to) / 2, y: top + height - 4, "text-anchor": "middle", style: `fill:${ink};font-size:11px` }, name));
  });
}

// An event that only one of the two has: a disc, with a cross where that is the engine.
function wrongEvent(at, spurious) {
  const mark = drawn("g", { transform: `translate(${at[0].toFixed(1)},${at[1].toFixed(1)})` });
  mark.append(drawn("circle", { r: 6, class: "wrong-event" }));
  if (spurious) mark.append(drawn("path", { d: "M-3,-3L3,3M3,-3L-3,3", class: "cross" }));
  return mark;
}

// Guard against time in one view. Truth in ink, the engine in its colour, what is wrong in yellow.
function eventChart(host, picture, view, height = 330) {
  const draw = () => {
    const width = Math.max(260, host.clientWidth);
    const [left, right, top, bottom] = [64, 12, 44, 44];
    const [w, h] = [width - left - right, height - top - bottom];
    const values = [...view.truth.values, ...view.engine.values, ...view.looks.map((it) => it[1]), 0].filter((v) => v !== null);
    const [sx, sy] = [factorOf([view.from, view.to]), factorOf(values)];
    const [ax, ay] = [axisOver([view.from, view.to].map((t) => t / 10 ** sx), {}), axisOver(values.map((v) => v / 10 ** sy), {})];
    const x = (t) => left + (w * (t - view.from)) / (view.to - view.from);
    const y = (v) => top + h * (1 - ay.place(v / 10 ** sy));
    const tone = colour(picture.engine);
    const svg = drawn("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${picture.guard} against time, truth and ${picture.engine}` });
    const ticks = ax.ticks.map(([, label]) => [x(Number(label) * 10 ** sx), label]).filter(([px]) => px >= left - 0.5 && px <= left + w + 0.5);
    const every = Math.ceil((ticks.length * 54) / w);
    ticks.forEach(([px, label], i) => {
      svg.append(drawn("line", { class: "grid", x1: px, x2: px, y1: top, y2: top + h }));
      if (i % every === 0) svg.append(drawn("text", { x: px, y: top + h + 16, "text-anchor": "middle" }, label.replace("-", "−")));
    });
    for (const [share, label] of ay.ticks) {
      const py = top + h * (1 - share);
      svg.append(drawn("line", { class: "grid", x1: left, x2: left + w, y1: py, y2: py }));
      svg.append(drawn("text", { x: left - 7, y: py + 4, "text-anchor": "end" }, label.replace("-", "−")));
    }
    svg.append(drawn("line", { x1: left, x2: left + w, y1: y(0), y2: y(0), class: "threshold" }));
    svg.append(drawn("line", { x1: x(0), x2: x(0), y1: top, y2: top + h, class: "wrong", "stroke-dasharray": "3 3" }));
    svg.append(drawn("rect", { class: "frame", x: left, y: top, width: w, height: h }));
    [["truth", view.truth, 4], ["engine", view.engine, 22]].forEach(([name, trajectory, at]) => {
      band(svg, picture.modes, trajectory, [left, at, w, 15], x);
      svg.append(drawn("text", { x: left - 7, y: at + 12, "text-anchor": "end" }, name));
    });
    const curve = (trajectory, style) => {
      const n = trajectory.values.length;
      if (n < 2) return;
      const known = trajectory.values.map((v, k) => [view.from + ((view.to - view.from) * k) / (n - 1), v]).filter(([, v]) => v !== null);
      const d = known.map(([t, v], k) => `${k ? "L" : "M"}${x(t).toFixed(1)},${y(v).toFixed(1)}`).join("");
      svg.append(drawn("path", { d, fill: "none", style, "stroke-linejoin": "round" }));
    };
    curve(view.truth, "stroke:var(--ink);stroke-width:4;opacity:.45");
    curve(view.engine, `stroke:${tone};stroke-width:2`);
    if (view.engine.values.length > 1) for (const t of view.steps) svg.append(drawn("circle", { cx: x(t), cy: y(along(view, view.engine.values, t)), r: 3.6, style: `fill:${tone};stroke:var(--paper)` }));
    for (const [t, v] of view.looks.filter((it) => it[1] !== null)) svg.append(drawn("path", { d: LOOK, transform: `translate(${x(t).toFixed(1)},${y(v).toFixed(1)})`, class: "look", style: `stroke:${tone}` }));
    for (const it of view.truth.events) svg.append(it.matched ? drawn("circle", { cx: x(it.t), cy: y(0), r: 3.5, class: "true-event" }) : wrongEvent([x(it.t), y(0)], false));
    for (const it of view.engine.events) svg.append(it.matched ? markerOf("triangle", [x(it.t), y(0) + 9], tone) : wrongEvent([x(it.t), y(0)], true));
    svg.append(drawn("text", { x: left + w / 2, y: height - 6, "text-anchor": "middle", class: "axis" }, withFactor(`time − ${picture.centre.toPrecision(8)}`, sx)));
    svg.append(drawn("text", { transform: `translate(13,${top + h / 2}) rotate(-90)`, "text-anchor": "middle", class: "axis" }, withFactor(picture.guard, sy)));
    host.replaceChildren(svg);
  };
  host.redraw = draw;
  draw();
}

function eventKey(picture) {
  const tone = colour(picture.engine);
  const sample = (...parts) => {
    const svg = drawn("svg", { width: 22, height: 14, viewBox: "-11 -7 22 14", "aria-hidden": "true" });
    svg.append(...parts);
    return svg;
  };
  const line = (style) => sample(drawn("path", { d: "M-11,0H11", style }));
  const known = picture.views.some((view) => view.engine.values.length);
  const entries = [
    [line("stroke:var(--ink);stroke-width:4;opacity:.45"), "truth"],
    known && [line(`stroke:${tone};stroke-width:2`), picture.engine],
    known && [sample(drawn("circle", { r: 3.6, style: `fill:${tone};stroke:var(--paper)` })), "end of an accepted step"],
    known && [sample(drawn("path", { d: LOOK, class: "look", style: `stroke:${tone}` })), "the root finder looked here"],
    [sample(drawn("circle", { r: 3.5, class: "true-event" })), "event of the truth"],
    [sample(markerOf("triangle", [0, 0], tone)), "event of the engine"],
    [sample(wrongEvent([0, 0], false)), "missed"],
    [sample(wrongEvent([0, 0], true)), "spurious"],
  ];
  return element("div", { class: "legend" }, ...entries.filter(Boolean).map(([svg, text]) => element("span", {}, svg, text)));
}

// The picture of a row, to be drawn once it stands in the page; null where there is none.
function eventPicture(row) {
  const picture = data.events.find((it) => it.row === row);
  if (!picture) return null;
  const [wide, close] = [element("div", { class: "chart" }), element("div", { class: "chart" })];
  const last = picture.views.length - 1;
  let level = picture.telling;
  const show = () => {
    eventChart(close, picture, picture.views[level]);
    [closer.disabled, wider.disabled] = [level >= last, level <= Math.min(1, last)];
    scale.textContent = `close-up ${level} of ${last}`;
  };
  const button = (text, title, change) => element("button", { type: "button", title, onclick: () => {
    level += change;
    show();
  } }, text);
  const [wider, closer, scale] = [button("wider", "show more time around the event", -1), button("closer", "show less time around the event", 1), element("span", { class: "muted" })];
  const panels = [element("div", {}, element("div", { class: "zoom muted" }, "some steps around the event"), wide)];
  if (last > 0) panels.push(element("div", {}, element("div", { class: "zoom" }, scale, wider, closer), close));
  const block = element("div", { class: "event" }, element("h4", {}, picture.title), element("div", { class: "pair" }, ...panels), eventKey(picture));
  block.show = () => {
    eventChart(wide, picture, picture.views[0]);
    if (last > 0) show();
  };
  return block;
}
