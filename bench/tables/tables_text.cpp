#include "bench/tables/tables_text.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "bench/output/data.h"
#include "bench/output/markdown.h"
#include "bench/tables/provenance.h"
#include "bench/tables/run_times.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {

namespace {

constexpr std::size_t kMostLetters = 16;  // of a scene's name in a terminal
constexpr std::size_t kLineWidth = 100;   // of a terminal

bool is_first_byte(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

// How many columns of a terminal a text in UTF-8 takes, if every letter takes one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, is_first_byte));
}

// A long name without its middle: names of one family differ at the end.
std::string shortened(const std::string& text) {
  constexpr std::size_t kBeginning = 8, kEnd = kMostLetters - kBeginning - 2;
  const std::size_t width = width_of(text);
  if (width <= kMostLetters) return text;
  std::string beginning, end;
  std::size_t letter = 0;
  for (const char c : text) {
    letter += is_first_byte(c);
    if (letter <= kBeginning) beginning += c;
    if (letter > width - kEnd) end += c;
  }
  return beginning + ".." + end;
}

std::string left(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}
std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, width_of(text)), ' ') + text;
}
// "--- RVBC ---" where there is room, to show which columns a title is above.
std::string centred(const std::string& text, std::size_t width) {
  if (text.empty() || width < width_of(text) + 4) return right(text, width);
  const std::size_t free = width - width_of(text) - 2;
  return std::string(free / 2, '-') + " " + text + " " + std::string(free - free / 2, '-');
}

void end_line(std::string& out) {
  while (out.ends_with(' ')) out.pop_back();
  out += '\n';
}

// The columns [first, last) of a table, of whole groups.
struct Block {
  std::size_t first, last;
  std::string groups;  // the line of their titles
};

// Distributes the groups over blocks that fit a terminal beside the labels. Widens columns under long titles,
// and the first of a group, which stands a little apart from the group before.
std::vector<Block> blocks_of(const ShapedTable& table, std::size_t label_width,
                             std::vector<std::size_t>& widths) {
  std::vector<Block> blocks;
  std::size_t first = 0, block_width = 0;
  for (const ShapedTable::Group& group : table.groups) {
    const std::size_t last = first + group.columns;
    std::size_t width = 0;
    for (std::size_t i = first; i < last; ++i) width += widths[i];
    const std::size_t title_width = width_of(group.title) + 1;
    if (title_width > width) {
      widths[last - 1] += title_width - width;
      width = title_width;
    }
    if (blocks.empty() || block_width + width + 1 > kLineWidth) {
      blocks.push_back({first, first, std::string(label_width, ' ')});
      block_width = label_width;
    } else {
      widths[first] += 1;
      block_width += 1;
      blocks.back().groups += ' ';
    }
    blocks.back().groups += " " + centred(group.title, width - 1);
    blocks.back().last = last;
    block_width += width;
    first = last;
  }
  return blocks;
}

std::string table_text(const ShapedTable& table) {
  std::size_t scene_width = 0, label_width = 0;
  for (const ShapedTable::Line& line : table.lines)
    if (!line.kind.empty()) scene_width = std::max(scene_width, width_of(shortened(line.scene)) + 1);
  const auto label = [&](const ShapedTable::Line& line) {
    return line.kind.empty() ? line.scene : left(shortened(line.scene), scene_width) + line.kind;
  };
  for (const ShapedTable::Line& line : table.lines)
    label_width = std::max(label_width, width_of(label(line)));

  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    std::size_t width = std::max(width_of(shortened(table.columns[i].head)), width_of(table.columns[i].unit));
    for (const ShapedTable::Line& line : table.lines) width = std::max(width, width_of(line.cells[i]));
    widths.push_back(width + 1);
  }
  std::string out = table.title + "\n" + table.legend + "\n";
  for (const Block& block : blocks_of(table, label_width, widths)) {
    std::string groups = block.groups, heads(label_width, ' '), units = heads;
    for (std::size_t i = block.first; i < block.last; ++i) {
      heads += right(shortened(table.columns[i].head), widths[i]);
      units += right(table.columns[i].unit, widths[i]);
    }
    for (std::string* line : {&groups, &heads, &units}) {
      end_line(*line);
      if (*line != "\n") out += *line;
    }
    for (std::size_t l = 0; l < table.lines.size(); ++l) {
      const ShapedTable::Line& line = table.lines[l];
      if (table.begins_today(l)) out += std::string(kTodayNote) + ":\n";
      out += left(label(line), label_width);
      for (std::size_t i = block.first; i < block.last; ++i)
        out += right(line.cells[i].empty() ? "-" : line.cells[i], widths[i]);
      end_line(out);
    }
  }
  return out;
}

// A name, then a text in as many lines as it takes. At least one blank stands between the two.
std::string remark_text(const Remark& remark) {
  constexpr std::size_t kNameWidth = 12;
  const auto& [name, text] = remark;
  std::string out, line = left(name.empty() ? name : name + " ", kNameWidth);
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (width_of(line) > kNameWidth && width_of(line) + width_of(word) > kLineWidth) {
      end_line(line);
      out += line;
      line = std::string(kNameWidth, ' ');
    }
    line += word + " ";
    at = end + 1;
  }
  end_line(line);
  return out + line;
}

std::string published_machine() {
  return data_json("published.json").at("machine").get<std::string>();
}

bool is_published(const ShapedTable& table) {
  return std::ranges::find(table.lines, "published", &ShapedTable::Line::kind) != table.lines.end();
}

// "1.32 to 7.88".
std::string range_text(std::vector<double> values, const char* between = " to ") {
  std::ranges::sort(values);
  const std::string low = figure_text(values.front()), high = figure_text(values.back());
  return low == high ? low : low + between + high;
}

std::size_t count(std::span<const ClaimResult> claims, ClaimVerdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(claims, verdict, &ClaimResult::verdict));
}

// How many of the claims about the measured scenes are reproduced, and how many in part; empty where none was
// measured.
std::string claims_text(std::span<const ClaimResult> claims) {
  const std::size_t reproduced = count(claims, ClaimVerdict::reproduced),
                    partly = count(claims, ClaimVerdict::partly),
                    measured = claims.size() - count(claims, ClaimVerdict::not_measured);
  if (measured == 0) return "";
  return std::to_string(reproduced) + " of the paper's " + std::to_string(measured) +
         " claims about these scenes are reproduced" +
         (partly > 0 ? ", " + std::to_string(partly) + " in part" : "");
}

// Why nothing is claimed from some of the records, the first reason that any gives; empty where something is
// claimed from all.
std::string no_claims_from(std::span<const Record> records) {
  for (const Record& record : records)
    if (std::string why = no_claims_text(record); !why.empty()) return why;
  return "";
}

constexpr char kFirst[] = "drvbc_fast", kPaper[] = "drvbc";

// A line of what the median query takes a row of the fast engine, and of how many times faster that is than
// a row that is asked the same: "first contact: 5.2-14.6 times faster than drvbc". Empty where it was not
// timed.
std::string fast_text(std::span<const Record> records, const std::string& fast, const std::string& question,
                      const std::string& than, const std::string& than_text) {
  std::vector<double> medians, ratios;
  bool marked = false;
  for (const Record& record : records) {
    if (record.pipeline != Pipeline::vectorised) continue;
    const Measured median = median_query(fast, record);
    if (!median.value) continue;
    medians.push_back(*median.value);
    marked = marked || median.marked;
    const Measured ratio = median_query(than, record, fast);
    if (!ratio.value) continue;
    ratios.push_back(*ratio.value);
    marked = marked || ratio.marked;
  }
  if (medians.empty()) return "";
  const std::string mark = marked ? std::string(kShortfallMark) : "";
  std::string out = range_text(medians, "-") + mark + " ms the median query; " + question;
  if (!ratios.empty()) out += ": " + range_text(ratios, "-") + mark + " times faster than " + than_text;
  return out;
}

std::string code_around(std::span<const Record> records) {
  return pipelines_of(records).front() == Pipeline::published
             ? "published: the paper's code around every method"
             : "today: this project's code around every method";
}

std::string section_of(const ShapedTable& table) {
  return "\n## " + table.title + "\n\n" + table.legend + "\n\n" + markdown_of(table) +
         (table.has_marks() ? std::string("\n\\") + kShortfallMeaning + "\n" : "");
}

std::string claims_section(std::span<const ClaimResult> claims, const std::string& why_none) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> not_measured;
  for (const ClaimResult& claim : claims) {
    if (claim.verdict == ClaimVerdict::not_measured) {
      not_measured.push_back(claim.id);
      continue;
    }
    std::vector<double> values;
    for (const Evidence& evidence : claim.evidence)
      if (evidence.measured.value) values.push_back(*evidence.measured.value);
    rows.push_back({claim.id, std::string(to_string(claim.verdict)), claim.expectation, range_text(values)});
  }
  if (rows.empty())
    return why_none.empty() ? "" : "\n## The paper's claims\n\nNone is made where " + why_none + ".\n";
  const std::vector<std::string> head = {"claim", "verdict", "expected", "measured"};
  return "\n## The paper's claims\n\n" + claims_text(claims) +
         ". Each with its quote and its evidence: " + "[claims](claims.md).\n\n" +
         markdown_table(head, rows) +
         (not_measured.empty() ? "" : "\nNot measured: " + joined(not_measured) + ".\n");
}

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

std::vector<Remark> remarks(std::span<const ShapedTable> tables, std::span<const ClaimResult> claims,
                            std::span<const Record> records) {
  std::vector<Remark> out = {{"measured", joined(environments(records), "; and ")},
                             {"pipeline", code_around(records)}};
  if (std::ranges::any_of(tables, is_published)) out.push_back({"published", published_machine()});
  const std::string held = claims_text(claims), why_none = no_claims_from(records);
  if (!held.empty()) out.push_back({"claims", held});
  if (!why_none.empty()) {  // nothing is said of speed where nothing may be claimed
    out.push_back({held.empty() ? "claims" : "", "none is made where " + why_none});
    return out;
  }
  const std::string all = row_of_all_contacts(records);
  out.push_back({kFirst, fast_text(records, kFirst, "first contact", kPaper, kPaper)});
  out.push_back({all, fast_text(records, all, "all contacts", kBestBaseline,
                                "the best complete row of another method")});
  std::erase_if(out, [](const Remark& one) { return one.text.empty(); });
  return out;
}

std::string tables_text(std::span<const ShapedTable> tables, std::span<const Remark> remarks,
                        const std::string& page) {
  const bool has_published = std::ranges::any_of(tables, is_published);
  std::string out, said;
  bool marked = false;
  for (const ShapedTable& table : tables) {
    if (has_published && table.id == "strategies") continue;  // long, and on the page
    out += table_text(table) + "\n";
    marked = marked || table.has_marks();
  }
  for (const Remark& one : remarks) said += remark_text(one);
  if (marked || said.find(kShortfallMark) != std::string::npos) out += std::string(kShortfallMeaning) + "\n";
  return out + said + (page.empty() ? "" : remark_text({"page", page}));
}

std::string tables_markdown(std::span<const ShapedTable> tables, std::span<const ClaimResult> claims,
                            std::span<const Record> records) {
  std::string out = "# Published and measured\n\nMeasured: " + joined(environments(records), "; and ") +
                    "; pipeline " + code_around(records) + ".\n";
  if (std::ranges::any_of(tables, is_published)) out += "Published: " + published_machine() + ".\n";
  out +=
      "\nA dash stands where there is no figure. Every figure, with its 95 % interval, is in `tables.csv` "
      "and `tables.json`.\n";
  for (const ShapedTable& table : tables) out += section_of(table);
  return out + claims_section(claims, claims.empty() ? "" : no_claims_from(records)) +
         "\n## How it was measured\n\n" + how_measured(records);
}

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
  if (table.has_marks()) caption += std::string(" ") + kShortfallMeaning + ".";
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
