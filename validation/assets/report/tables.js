// Tables that stand in the page already: sorted by a click on a heading, and linked to the rows of
// results.

// What a cell counts for: its number where it is one, its text otherwise; a dash counts for
// nothing.
function weight(cell) {
  const text = (cell?.dataset.sort ?? cell?.textContent ?? "").trim();
  if (text === "–" || text === "") return null;
  if (text === "∞") return Infinity;
  const figure = Number(text.replace(/[\u202f\s%]/g, "").replace(/^h/, ""));
  return Number.isNaN(figure) ? text : figure;
}

function compare(a, b) {
  if (a === null || b === null) return 0;
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", { numeric: true });
}

function sortable(table) {
  const [heads, body] = [[...table.tHead.rows[0].cells], table.tBodies[0]];
  const sort = (k) => {
    const down = heads[k].getAttribute("aria-sort") === "ascending";
    heads.forEach((head, i) => head.setAttribute("aria-sort", i === k ? (down ? "descending" : "ascending") : "none"));
    const rows = [...body.rows].map((row) => [weight(row.cells[k]), row]);
    // What was not measured comes last, either way.
    rows.sort(([a], [b]) => (a === null) - (b === null) || (down ? compare(b, a) : compare(a, b)));
    body.append(...rows.map(([, row]) => row));
  };
  heads.forEach((head, k) => {
    head.setAttribute("aria-sort", "none");
    head.replaceChildren(element("button", { type: "button", onclick: () => sort(k) }, ...head.childNodes));
  });
}

document.querySelectorAll("table.sortable").forEach(sortable);
document.querySelectorAll("a[data-engine]").forEach((link) => link.addEventListener("click", () => {
  if (count) filterBy({ engine: link.dataset.engine, case: link.dataset.case ?? "", verdict: link.dataset.verdict ?? "", text: link.dataset.text ?? "" });
}));
