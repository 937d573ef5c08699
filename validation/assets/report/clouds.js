// The Poincare sections: too many points for SVG, so they are painted.

function paint(canvas, points, axes, color) {
  const scale = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  [canvas.width, canvas.height] = [width * scale, height * scale];
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  const [left, right, top, bottom] = [52, 10, 8, 40];
  const [w, h] = [width - left - right, height - top - bottom];
  context.font = "12px system-ui, sans-serif";
  context.strokeStyle = ink("--line");
  context.fillStyle = ink("--muted");
  context.textAlign = "center";
  for (const [share, label] of axes[0].ticks) {
    context.beginPath();
    context.moveTo(left + w * share, top);
    context.lineTo(left + w * share, top + h);
    context.stroke();
    context.fillText(label, left + w * share, top + h + 16);
  }
  context.textAlign = "right";
  for (const [share, label] of axes[1].ticks) {
    context.beginPath();
    context.moveTo(left, top + h * (1 - share));
    context.lineTo(left + w, top + h * (1 - share));
    context.stroke();
    context.fillText(label, left - 6, top + h * (1 - share) + 4);
  }
  context.textAlign = "center";
  context.fillStyle = ink("--ink");
  context.fillText("p", left + w / 2, height - 6);
  context.fillText("y", 10, top + h / 2);
  context.fillStyle = color;
  for (const [p, y] of points) {
    if (p === null || y === null) continue;
    context.fillRect(left + w * axes[0].place(p) - 0.6, top + h * (1 - axes[1].place(y)) - 0.6, 1.3, 1.3);
  }
}

function clouds() {
  const hosts = [...document.querySelectorAll("canvas.cloud")];
  const all = () => hosts.forEach((canvas) => {
    const pair = data.sections[Number(canvas.dataset.pair)];
    const both = [...pair.exact, ...pair.direct];
    const axes = [0, 1].map((k) => axisOver(both.map((it) => it[k]), {}));
    if (!axes[0] || !axes[1]) return;
    paint(canvas, pair[canvas.dataset.side], axes, ink(canvas.dataset.side === "exact" ? "--ink" : "--accent"));
  });
  if (!hosts.length) return;
  const box = element("div", { class: "chart", hidden: "" });
  box.redraw = all;
  document.body.append(box);
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", all);
  all();
}

clouds();
