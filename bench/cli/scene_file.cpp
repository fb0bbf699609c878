#include "bench/cli/scene_file.h"

#include <algorithm>
#include <initializer_list>
#include <vector>

#include "bench/output/markdown.h"
#include "core/base/number_text.h"
#include "scenes/catalog/scene.h"
#include "scenes/catalog/shapes.h"
#include "scenes/effects/effect.h"

namespace cscd::bench {
namespace {

using scenes::ParameterKind;
using scenes::ParameterRow;

std::string number(double value) {
  return rounded_text(value, 10);
}

std::string type(const ParameterRow& row) {
  if (row.kind == ParameterKind::table) return "rows of " + std::to_string(row.columns) + " numbers";
  if (row.kind == ParameterKind::vector) return "3 numbers";
  if (row.kind == ParameterKind::objects) return "list of objects";
  return std::string(to_string(row.kind));
}

std::string default_text(const ParameterRow& row) {
  if (row.required) return "required";
  if (row.otherwise.empty()) return "none";
  std::string out;
  for (const double value : row.otherwise) out += (out.empty() ? "" : ", ") + number(value);
  return out.size() > 1 && row.otherwise.size() > 1 ? "[" + out + "]" : out;
}

// Empty where every value goes.
std::string range(const ParameterRow& row) {
  if (row.range.least <= -1e9) return "";
  if (row.range.most >= 1e9) return "from " + number(row.range.least);
  return number(row.range.least) + " to " + number(row.range.most);
}

std::string range(const scenes::SceneField& field) {
  return field.most == 0 ? "" : std::to_string(field.least) + " to " + std::to_string(field.most);
}

std::string name(const ParameterRow& row) {
  return row.name == "*" ? "NAMES" : std::string(row.name);
}

// Tables of words have all columns to the left.
std::string word_table(std::initializer_list<std::string> head,
                       const std::vector<std::vector<std::string>>& rows) {
  std::string out = markdown_table(std::vector<std::string>(head), rows);
  const std::size_t begin = out.find('\n') + 1, end = out.find('\n', begin);
  out.erase(std::remove(out.begin() + static_cast<std::ptrdiff_t>(begin),
                        out.begin() + static_cast<std::ptrdiff_t>(end), ':'),
            out.begin() + static_cast<std::ptrdiff_t>(end));
  return out;
}

// A text whose lines begin at a column and end before another.
std::string wrapped(std::string_view text, std::size_t column) {
  constexpr std::size_t kEnd = 110;
  std::string out;
  while (!text.empty()) {
    const std::size_t room = kEnd - column;
    std::size_t length = text.size();
    if (length > room) length = text.find_last_of(' ', room);
    if (length == std::string_view::npos) length = std::min(text.find(' '), text.size());
    out += std::string(column, ' ') + std::string(text.substr(0, length)) + "\n";
    text.remove_prefix(std::min(length + 1, text.size()));
  }
  return out;
}

// Each list of objects among the parameters has a table of its own.
void add_markdown(std::span<const ParameterRow> rows, const std::string& of, std::string& out) {
  if (rows.empty()) {
    out += "\nNo parameters.\n";
    return;
  }
  std::vector<std::vector<std::string>> lines;
  for (const ParameterRow& row : rows)
    lines.push_back({"`" + name(row) + "`", type(row), std::string(row.unit), default_text(row), range(row),
                     std::string(row.meaning)});
  out += (of.empty() ? "" : "\nEach object of `" + of + "`:\n");
  out +=
      "\n" + markdown_table(
                 std::vector<std::string>{"parameter", "type", "unit", "default", "range", "meaning"}, lines);
  for (const ParameterRow& row : rows)
    if (!row.items.empty()) add_markdown(row.items, std::string(row.name), out);
}

// Calls `each` with kind, name, description and parameters of every shape, and then of every effect.
template <class Each>
void for_each_section(const Each& each) {
  for (const scenes::ShapeRow& row : scenes::shapes())
    each("Shape", row.name, row.description, row.parameters);
  for (const scenes::EffectRow& row : scenes::effects())
    each("Effect", row.name, row.description, row.parameters);
}

constexpr char kIntroduction[] =
    "A scene file is a JSON object, `scenes/NAME.json` or any other file whose name ends in `.json`. It "
    "names a\n"
    "shape and the effects that move the shape. Lengths are in a unit of the scene's own, times are in "
    "frames,\n"
    "angles are in turns. A member or a parameter that is not listed here is refused.\n";

}  // namespace

std::string parameters_text(std::span<const ParameterRow> rows, std::size_t indent) {
  std::string out;
  std::size_t width = 0;
  for (const ParameterRow& row : rows) width = std::max(width, name(row).size());
  for (const ParameterRow& row : rows) {
    std::string facts = type(row);
    if (!row.unit.empty()) facts += "; unit " + std::string(row.unit);
    if (!range(row).empty()) facts += "; " + range(row);
    facts += row.required            ? "; required"
             : row.otherwise.empty() ? "; optional"
                                     : "; default " + default_text(row);
    const std::size_t column = indent + width + 2;
    out += std::string(indent, ' ') + name(row) + std::string(width + 2 - name(row).size(), ' ') + facts +
           "\n" + wrapped(row.meaning, column);
    if (!row.items.empty()) out += parameters_text(row.items, column);
  }
  return out;
}

std::string scene_file_text() {
  std::string out = std::string(kIntroduction) + "\nMembers\n";
  for (const scenes::SceneField& field : scenes::scene_fields()) {
    const std::string within = range(field);
    out += "  " + std::string(field.name) + std::string(10 - field.name.size(), ' ') +
           std::string(field.type) + (within.empty() ? "" : "; " + within) +
           (field.required ? "; required" : "; optional") + "\n" + wrapped(field.meaning, 12);
  }
  out += "\nShapes and effects; `cscd list NAME` shows the parameters of one of them\n";
  for_each_section(
      [&](const std::string& kind, std::string_view name, std::string_view description, const auto&) {
        out += wrapped(kind + " " + std::string(name) + ": " + std::string(description), 2);
      });
  return out;
}

std::string scene_file_markdown() {
  std::string out =
      "# What a scene file holds\n\n" + std::string(kIntroduction) +
      "`cscd list scene-file --markdown` writes this page from the rows by which the program reads scene\n"
      "files, and a test compares the two. What else a new scene needs: [to "
      "add](../bench/README.md#to-add).\n";
  std::vector<std::vector<std::string>> lines;
  for (const scenes::SceneField& field : scenes::scene_fields())
    lines.push_back({"`" + std::string(field.name) + "`", std::string(field.type),
                     field.required ? "yes" : "no", range(field), std::string(field.meaning)});
  out += "\n" + word_table({"member", "type", "required, here or in `base`", "range", "meaning"}, lines);
  for_each_section([&](const std::string& kind, std::string_view name, std::string_view description,
                       const auto& parameters) {
    out += "\n## " + kind + " `" + std::string(name) + "`\n\n" + std::string(description) + "\n";
    add_markdown(parameters, "", out);
  });
  return out;
}

}  // namespace cscd::bench
