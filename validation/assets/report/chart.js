// A chart: curves with markers on linear or logarithmic axes, redrawn at the width that there is.

// Paths of markers about the origin.
const MARKERS = {
  circle: "M-4,0a4,4 0 1,0 8,0a4,4 0 1,0 -8,0Z",
  square: "M-3.6,-3.6h7.2v7.2h-7.2Z",
  triangle: "M0,-4.8L4.6,3.6H-4.6Z",
  nabla: "M0,4.8L4.6,-3.6H-4.6Z",
  diamond: "M0,-5.2L5.2,0L0,5.2L-5.2,0Z",
  cross: "M-3.8,-3.8L3.8,3.8M3.8,-3.8L-3.8,3.8",
  plus: "M0,-5V5M-5,0H5",
};

function markerOf(name, at, color, hollow = false) {
  const open = name === "cross" || name === "plus";
  if (hollow) return hollowMarker(name, at, color, open);
  return drawn("path", {
    d: MARKERS[name] ?? MARKERS.circle,
    transform: `translate(${at[0].toFixed(1)},${at[1].toFixed(1)})`,
    style: open ? `stroke:${color};fill:none` : `fill:${color};stroke:var(--paper)`,
    "stroke-width": open ? 2.2 : 1,
  });
}

// Only the outline of a marker; one of lines, which has none, in a ring.
function hollowMarker(name, at, color, open) {
  const mark = drawn("g", { transform: `translate(${at[0].toFixed(1)},${at[1].toFixed(1)})` });
  mark.append(drawn("path", { d: MARKERS[open ? "circle" : name] ?? MARKERS.circle, transform: `scale(${open ? 1.7 : 1.2})`, style: `stroke:${color};fill:var(--paper)`, "stroke-width": 1.5 }));
  if (open) mark.append(drawn("path", { d: MARKERS[name], transform: "scale(0.8)", style: `stroke:${color};fill:none`, "stroke-width": 2 }));
  return mark;
}

// Range and ticks of an axis over finite values; null where there is nothing to show.
function axisOver(values, { log, low, high }) {
  const usable = values.filter((v) => Number.isFinite(v) && (!log || v > 0)).map((v) => (log ? Math.log10(v) : v));
  if (!usable.length) return null;
  let [from, to] = usable.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  if (low !== undefined) from = Math.min(from, low);
  if (high !== undefined) to = Math.max(to, high);
  if (log) {
    from = Math.floor(from - 0.05);
    to = Math.ceil(to + 0.05);
  } else {
    const room = 0.04 * (to - from) || 0.5;
    from -= low === from ? 0 : room;
    to += room;
  }
  const span = to - from;
  const rough = span / 7;
  const power = 10 ** Math.floor(Math.log10(rough));
  const nice = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= rough);
  const stride = log ? Math.max(1, Math.ceil(nice)) : nice;
  const ticks = [];
  for (let k = Math.ceil(from / stride - 1e-9); k * stride <= to + 1e-9 * span; k++) ticks.push(k * stride);
  const digits = Math.max(0, -Math.floor(Math.log10(stride) + 1e-9));
  const label = (t) => (log ? powerOfTen(Math.round(t)) : (Math.abs(t) < 1e-12 ? 0 : t).toFixed(Math.min(digits, 12)));
  // Zero and less lie on the edge of a logarithmic axis.
  const place = (v) => (((log ? (v > 0 ? Math.log10(v) : from) : v) - from) / span);
  return { ticks: ticks.map((t) => [(t - from) / span, label(t)]), place };
}

const tip = element("div", { class: "tip", role: "status", hidden: "" });
document.body.append(tip);

// series: { name, color, marker, dash, width, line, points: [[x, y, note, apart]] }; a point apart
// is hollow and not joined.
function chart(host, { x, y, series, height = 380 }) {
  const draw = () => {
    host.replaceChildren();
    const width = Math.max(280, host.clientWidth);
    const shown = series.map((s) => ({ ...s, points: s.points.filter((p) => Number.isFinite(p[0]) && Number.isFinite(p[1]) && (!x.log || p[0] > 0)) }));
    const all = shown.flatMap((s) => s.points);
    const [ax, ay] = [axisOver(all.map((p) => p[0]), x), axisOver(all.map((p) => p[1]), y)];
    if (!ax || !ay) {
      host.append(element("p", { class: "empty" }, "Nothing was measured for this choice."));
      return;
    }
    const [left, right, top, bottom] = [58, 14, 12, 46];
    const [w, h] = [width - left - right, height - top - bottom];
    const at = (p) => [left + w * ax.place(p[0]), top + h * (1 - ay.place(p[1]))];
    const svg = drawn("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${y.label} against ${x.label}` });
    const every = Math.ceil((ax.ticks.length * 46) / w);
    ax.ticks.forEach(([share, label], i) => {
      const px = left + w * share;
      svg.append(drawn("line", { class: "grid", x1: px, x2: px, y1: top, y2: top + h }));
      if (i % every === 0) svg.append(drawn("text", { x: px, y: top + h + 18, "text-anchor": "middle" }, label));
    });
    for (const [share, label] of ay.ticks) {
      const py = top + h * (1 - share);
      svg.append(drawn("line", { class: "grid", x1: left, x2: left + w, y1: py, y2: py }));
      svg.append(drawn("text", { x: left - 8, y: py + 4, "text-anchor": "end" }, label));
    }
    svg.append(drawn("rect", { class: "frame", x: left, y: top, width: w, height: h }));
    svg.append(drawn("text", { x: left + w / 2, y: height - 8, "text-anchor": "middle", class: "axis" }, x.label));
    svg.append(drawn("text", { transform: `translate(14,${top + h / 2}) rotate(-90)`, "text-anchor": "middle", class: "axis" }, y.label));
    const near = [];
    for (const s of shown) {
      const pixels = s.points.map(at);
      const joined = pixels.filter((_, i) => !s.points[i][3]);
      if (s.line !== false && joined.length > 1) {
        const d = joined.map((p, i) => `${i ? "L" : "M"}${p[0].toFixed(1)},${p[1].toFixed(1)}`).join("");
        svg.append(drawn("path", { d, fill: "none", style: `stroke:${s.color}`, "stroke-width": s.width ?? 1.8, "stroke-dasharray": s.dash ?? "none", "stroke-linejoin": "round" }));
      }
      pixels.forEach((p, i) => {
        if (s.marker) svg.append(markerOf(s.marker, p, s.color, s.points[i][3]));
        near.push([p, s, s.points[i]]);
      });
    }
    svg.addEventListener("pointermove", (event) => {
      const box = svg.getBoundingClientRect();
      const [mx, my] = [event.clientX - box.left, event.clientY - box.top];
      const best = near.reduce((a, b) => (Math.hypot(b[0][0] - mx, b[0][1] - my) < a[1] ? [b, Math.hypot(b[0][0] - mx, b[0][1] - my)] : a), [null, 28]);
      tip.hidden = !best[0];
      if (!best[0]) return;
      const [, s, p] = best[0];
      tip.textContent = `${s.name}${p[2] ? " " + p[2] : ""}: ${y.label} ${brief(p[1])} at ${x.label} ${brief(p[0])}`;
      tip.style.left = `${Math.max(8, Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 8))}px`;
      tip.style.top = `${event.clientY + 16}px`;
    });
    svg.addEventListener("pointerleave", () => (tip.hidden = true));
    host.append(svg);
  };
  host.redraw = draw;
  draw();
}

// The width changes: with the window, and on paper.
let before = window.innerWidth;
const redrawAll = () => document.querySelectorAll(".chart").forEach((host) => host.redraw?.());
window.addEventListener("resize", () => {
  if (window.innerWidth !== before) redrawAll();
  before = window.innerWidth;
});
window.addEventListener("beforeprint", redrawAll);
window.addEventListener("afterprint", redrawAll);
