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
