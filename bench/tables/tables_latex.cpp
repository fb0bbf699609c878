#include "bench/tables/tables_latex.h"

#include <cstddef>

namespace cscd::bench {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '_' || c == '%' || c == '&' || c == '#') out += '\\';
    if (c == '-' && out.ends_with('-')) out += "{}";  // TeX would draw a dash
    out += c;
  }
  return out;
}

// LaTeX numbers tables by itself, so the paper's number goes to the end.
std::string title(const std::string& text) {
  const std::size_t dot = text.find(". ");
  if (!text.starts_with("Table ") || dot == std::string::npos) return text;
  return text.substr(dot + 2) + " (the paper's " + text.substr(0, dot) + ")";
}

}  // namespace

std::string latex_table(const ShapedTable& table) {
  std::string groups, rules, heads, units, body;
  bool has_titles = false, has_units = false;
  for (std::size_t g = 0, first = 0; g < table.groups.size(); first += table.groups[g++].columns) {
    const std::string& text = table.groups[g].title;
    groups += " & \\multicolumn{" + std::to_string(table.groups[g].columns) + "}{c}{" + escaped(text) + "}";
    if (text.empty()) continue;
    has_titles = true;
    rules += "\\cmidrule(lr){" + std::to_string(first + 2) + "-" +
             std::to_string(first + 1 + table.groups[g].columns) + "}";
  }
  for (const ShapedTable::Column& column : table.columns) {
    heads += " & " + escaped(column.head);
    units += " & " + escaped(column.unit);
    has_units = has_units || !column.unit.empty();
  }
  for (std::size_t l = 0; l < table.lines.size(); ++l) {
    const ShapedTable::Line& line = table.lines[l];
    if (table.begins_today(l))
      body += "\\multicolumn{" + std::to_string(table.columns.size() + 1) + "}{@{}l}{\\emph{" +
              escaped(kTodayNote) + "}} \\\\\n";
    // A further line of a scene is indented beneath its name.
    body += line.scene.empty() ? "\\quad " + line.kind : escaped(line.scene);
    for (const std::string& cell : line.cells) body += " & " + (cell.empty() ? "--" : escaped(cell));
    body += " \\\\\n";
  }
  std::string caption = title(table.title) + ". " + table.legend;
  if (table.has_marks()) caption += std::string(" ") + kMarkNote + ".";
  return "% Made by `cscd tables`; needs \\usepackage{booktabs,graphicx}.\n\\begin{table*}\n\\centering\n"
         "\\footnotesize\n\\setlength{\\tabcolsep}{2pt}\n\\caption{" +
         escaped(caption) + "}\n\\label{tab:" + table.id +
         "}\n\\vspace{4pt}\n\\resizebox{\\ifdim\\width>\\textwidth\\textwidth\\else\\width\\fi}{!}{%"
         "\n\\begin{tabular}{@{}"
         "l" +
         std::string(table.columns.size(), 'r') + "@{}}\n\\toprule\n" +
         (has_titles ? groups.substr(1) + " \\\\\n" + rules + "\n" : "") + heads.substr(1) + " \\\\\n" +
         (has_units ? units.substr(1) + " \\\\\n" : "") + "\\midrule\n" + body +
         "\\bottomrule\n\\end{tabular}}\n\\end{table*}\n";
}

}  // namespace cscd::bench
