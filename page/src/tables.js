// Tables of the report. A cell is a text, or an element of its own.
import { element } from "./dom.js";

export function tableOf(head, rows) {
  const table = element("table"), top = element("tr");
  for (const name of head) top.append(element("th", name));
  table.append(top);
  for (const row of rows) {
    const line = element("tr");
    for (const cell of row) line.append(cell instanceof Node ? cell : element("td", cell));
    table.append(line);
  }
  return table;
}

// Titles of lines may be Markdown.
const plain = (text) => text.replaceAll(/[`*]/g, "");

// A table as the document has it: columns in groups, and beneath each scene's measured figures those published.
export function shapedTable({ title, legend, note, groups, columns, lines }) {
  const box = element("div"), wide = element("div", undefined, "wide"), table = element("table", undefined, "shaped");
  const named = lines.some((line) => line.kind), row = (cells) => {
    const line = element("tr");
    line.append(...cells);
    table.append(line);
    return line;
  };
  const spanning = (tag, text, count) => {
    const cell = element(tag, text);
    cell.colSpan = count;
    return cell;
  };
  const before = named ? 2 : 1;  // columns of names
  if (groups.some((group) => group.title)) row([spanning("th", "", before), ...groups.map((group) => spanning("th", group.title, group.columns))]).className = "groups";
  row([spanning("th", "", before), ...columns.map(({ head, unit }) => {
    const cell = element("th", head);
    if (unit) cell.append(element("small", unit));
    return cell;
  })]);
  for (const line of lines) {
    if (line.note) row([spanning("td", line.note, before + columns.length)]).className = "note";
    row([element("td", plain(line.scene)), ...(named ? [element("td", line.kind, "text")] : []), ...line.cells.map((cell) => element("td", cell.replaceAll("`", "") || "–"))]).className = line.kind;
  }
  wide.append(table);
  if (title) box.append(element("h3", title), element("p", legend, "hint"));
  box.append(wide);
  if (note) box.append(element("p", note, "hint"));
  return box;
}
