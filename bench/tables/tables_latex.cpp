#include "bench/tables/tables_latex.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "bench/tables/quantity.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kScenesAcross = 6;  // more do not fit in the width of a page

// What a table takes of a page, estimated in points of scriptsize type. A page is about 600 high, and 450
// wide.
constexpr std::size_t kMostHeight = 480, kLineHeight = 8, kIntervalHeight = 7;
constexpr std::size_t kWidth = 450, kMeasuredWidth = 40, kPaperWidth = 24, kLetterWidth = 4;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '_' || c == '%' || c == '&' || c == '#') out += '\\';
    out += c;
    if (c == '_') out += "\\allowbreak ";  // names of strategies are long
  }
  return out;
}

constexpr int kMostDecimals = 6;
constexpr double kLeast = 1e-6;  // a smaller number is shown as less than this one

// Three significant digits, or all digits before the point, without an exponent, which a column aligned at
// the point cannot hold. Behind the point stand six digits at most.
std::string digits(double value) {
  const double size = std::abs(value);
  int decimals = 0;
  if (size > 0 && size < 100 && value != std::floor(value))
    decimals = std::min(kMostDecimals, std::max(0, 2 - static_cast<int>(std::floor(std::log10(size)))));
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string interval(const Estimate& estimate) {
  return "{\\tiny " + digits(estimate.low) + "--" + digits(estimate.high) + "}";
}

// A column of numbers aligned at the point, as wide as the widest of them asks for.
class NumberColumn {
 public:
  void add(const std::string& text) {
    if (text.front() == '{') return;  // no number
    const std::size_t point = std::min(text.find('.'), text.size());
    before_ = std::max(before_, point);
    after_ = std::max(after_, text.size() - std::min(point + 1, text.size()));
    used_ = true;
  }
  bool used() const { return used_; }
  std::string definition() const {
    return "S[table-format=" + std::to_string(before_) + "." + std::to_string(after_) + "]";
  }

 private:
  std::size_t before_ = 1, after_ = 0;
  bool used_ = false;
};

constexpr char kMissing[] = "{--}";

std::string measured_text(const Cell& cell) {
  if (!cell.measured.value) return kMissing;
  const double value = *cell.measured.value;
  return value > 0 && value < kLeast ? "{$<$" + digits(kLeast) + "}" : digits(value);
}
// As many digits as the paper has.
std::string paper_text(const Cell& cell) {
  return cell.published ? number_text(*cell.published) : kMissing;
}

// LaTeX numbers tables by itself, so the paper's number goes to the end.
std::string title(const std::string& text) {
  const std::size_t dot = text.find(". ");
  if (!text.starts_with("Table ") || dot == std::string::npos) return text;
  return text.substr(dot + 2) + " (the paper's " + text.substr(0, dot) + ")";
}

// The part of a table that one float shows.
struct Part {
  std::span<const Row> rows;    // of the table: scenes
  std::size_t first, last;      // columns of the table: quantities
  std::optional<Pipeline> all;  // the pipeline of all columns of the table, where it is one
};

std::string label(const PaperTable& table, const Part& part, std::size_t i) {
  const Column& column = table.columns[i];
  std::string out = column.title + (column.unit.empty() ? "" : " (" + column.unit + ")");
  if (column.pipeline && !part.all) out += ", " + std::string(to_string(*column.pipeline));
  return out;
}

bool has_interval(const PaperTable& table, std::size_t i) {
  return std::ranges::any_of(table.rows,
                             [&](const Row& row) { return row.cells[i].measured.interval.has_value(); });
}

std::string float_text(const PaperTable& table, const Part& part, const std::string& name, bool continued) {
  std::vector<NumberColumn> measured(part.rows.size()), paper(part.rows.size());
  for (std::size_t s = 0; s < part.rows.size(); ++s)
    for (std::size_t i = part.first; i < part.last; ++i) {
      measured[s].add(measured_text(part.rows[s].cells[i]));
      paper[s].add(paper_text(part.rows[s].cells[i]));
    }
  const bool beside = std::ranges::any_of(paper, [](const NumberColumn& c) { return c.used(); });

  std::string columns, scenes, rules, heads, body;
  std::size_t at = 2;  // the number of the next column
  for (std::size_t s = 0; s < part.rows.size(); ++s) {
    const std::size_t wide = paper[s].used() ? 2 : 1;
    columns += " " + measured[s].definition() + (wide == 2 ? " " + paper[s].definition() : "");
    scenes += " & \\multicolumn{" + std::to_string(wide) + "}{c}{" + escaped(part.rows[s].scene) + "}";
    rules += "\\cmidrule(lr){" + std::to_string(at) + "-" + std::to_string(at + wide - 1) + "}";
    heads += std::string(" & {ours}") + (wide == 2 ? " & {paper}" : "");
    at += wide;
  }
  for (std::size_t i = part.first; i < part.last; ++i) {
    std::string figures, intervals;
    for (std::size_t s = 0; s < part.rows.size(); ++s) {
      const Cell& cell = part.rows[s].cells[i];
      figures += " & " + measured_text(cell) + (paper[s].used() ? " & " + paper_text(cell) : "");
      intervals += " & " + (cell.measured.interval ? interval(*cell.measured.interval) : "{}") +
                   (paper[s].used() ? " & {}" : "");
    }
    const bool has_second_line = has_interval(table, i);
    body += escaped(label(table, part, i)) + figures + (has_second_line ? " \\\\[-3pt]\n" : " \\\\\n");
    if (has_second_line) body += intervals.substr(1) + " \\\\\n";
  }

  std::string caption = title(table.title) + (continued ? ", continued" : "") + ".";
  caption += part.all ? " Pipeline: " + std::string(to_string(*part.all)) + "."
                      : " Figures that differ between the pipelines published and today name theirs.";
  if (body.find(kMissing) != std::string::npos)
    caption += " --: not published, or not measured, for the reason in tables.md.";
  if (body.find("\\tiny") != std::string::npos) caption += " Beneath: 95 % intervals.";
  return "% Made by `cscd tables`; needs "
         "\\usepackage{booktabs,tabularx,siunitx}.\n\\begin{table*}\n\\centering\n"
         "\\scriptsize\n\\setlength{\\tabcolsep}{2pt}\n\\sisetup{group-digits=none}\n\\caption{" +
         escaped(caption) + "}\n\\label{tab:" + name +
         "}\n\\begin{tabularx}{\\textwidth}{@{}>{\\raggedright\\arraybackslash}X" + columns +
         "@{}}\n\\toprule\n" + scenes.substr(1) + " \\\\\n" +
         (beside ? rules + "\n" + heads.substr(1) + " \\\\\n" : "") + "\\midrule\n" + body +
         "\\bottomrule\n\\end{tabularx}\n\\end{table*}\n";
}

// The quantities from one on that fit on a page.
std::size_t end_of_page(const PaperTable& table, const Part& part, std::size_t first) {
  const std::size_t letters_a_line =
      (kWidth - part.rows.size() * (kMeasuredWidth + kPaperWidth)) / kLetterWidth;
  std::size_t height = 0, i = first;
  for (; i < table.columns.size(); ++i) {
    height += kLineHeight * (1 + label(table, part, i).size() / letters_a_line) +
              (has_interval(table, i) ? kIntervalHeight : 0);
    if (height > kMostHeight && i > first) break;
  }
  return i;
}

}  // namespace

std::vector<LatexTable> latex_tables(std::span<const PaperTable> tables) {
  std::vector<LatexTable> out;
  for (const PaperTable& table : tables) {
    if (table.rows.empty() || table.columns.empty() || table.columns.size() > kMostLatexRows) continue;
    Part part{};
    part.all = only_pipeline(table);
    std::size_t number = 0;
    for (std::size_t scene = 0; scene < table.rows.size(); scene += kScenesAcross) {
      part.rows = std::span(table.rows).subspan(scene, std::min(kScenesAcross, table.rows.size() - scene));
      for (part.first = 0; part.first < table.columns.size(); part.first = part.last) {
        part.last = end_of_page(table, part, part.first);
        const std::string name = table.id + (number == 0 ? "" : "-" + std::to_string(number + 1));
        out.push_back({name, float_text(table, part, name, number > 0)});
        ++number;
      }
    }
  }
  return out;
}

}  // namespace cscd::bench
