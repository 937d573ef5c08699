"use strict";
// What the other scripts share: the data, elements, and numbers as text.
const data = JSON.parse(document.getElementById("data").textContent);
const SVG = "http://www.w3.org/2000/svg";

function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

function drawn(name, attributes, text) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

const SUPERSCRIPTS = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
function powerOfTen(exponent) {
  return "10" + [...String(exponent)].map((c) => SUPERSCRIPTS[c]).join("");
}

// Two digits, for people.
function brief(value) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value)) return value.toLocaleString("en").replaceAll(",", "\u202f");
  const size = Math.abs(value);
  if (size >= 0.01 && size < 10000) return value.toPrecision(3);
  return value.toExponential(1).replace("e+", "e");
}

const colour = (engine) => {
  const i = data.engines.findIndex((it) => it.name === engine);
  return i < 0 ? "var(--muted)" : `var(--e${i})`;
};
const marker = (engine) => data.engines.find((it) => it.name === engine)?.marker ?? "circle";

// Colours for what is painted. Paper is white, whatever the screen is, and styles say so too late.
let printing = false;
window.addEventListener("beforeprint", () => (printing = true));
window.addEventListener("afterprint", () => (printing = false));
const PAPER = { "--line": "#dfe3e8", "--muted": "#5b6470", "--ink": "#1b1f24", "--accent": "#0b62b8" };
const ink = (name) => (printing ? PAPER[name] : getComputedStyle(document.documentElement).getPropertyValue(name).trim());
