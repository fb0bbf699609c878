#include "scenes/character/report.h"

#include <charconv>
#include <functional>
#include <map>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

constexpr char kSchema[] = "cscd.import/1";

std::string shown(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}
std::string shown(std::size_t value) {
  return std::to_string(value);
}
std::string shown(long value) {
  return std::to_string(value);
}
std::string shown(const std::string& value) {
  return printable(value);
}

void read(const std::string& word, std::string& value) {
  value = printable(word);
}
template <class Number>
void read(const std::string& word, Number& value) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !(value - value == 0))
    throw InputError("import report: '" + printable(word) + "' is not a number");
}

// One list of the single values serves both ways.
template <class Report, class Visit>
void visit_values(Report& r, Visit&& visit) {
  visit("format", r.format);
  visit("centimetres_per_unit", r.centimetres_per_unit);
  visit("nodes", r.nodes);
  visit("meshes", r.meshes);
  visit("joints", r.joints);
  visit("vertices", r.vertices);
  visit("triangles", r.triangles);
  visit("most_influences", r.most_influences);
  visit("chosen_clip", r.chosen_clip);
  visit("fps", r.fps);
  visit("lead_in", r.lead_in);
  visit("weld_tolerance", r.weld_tolerance);
  visit("weld_spread", r.weld_spread);
  visit("welded_vertices", r.welded_vertices);
  visit("collapsed_triangles", r.collapsed_triangles);
  visit("duplicate_triangles", r.duplicate_triangles);
  visit("filled_holes", r.filled_holes);
  visit("filled_triangles", r.filled_triangles);
  visit("flipped_components", r.flipped_components);
  visit("components", r.components);
  visit("chosen_triangles", r.chosen_triangles);
}

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> words(1);
  for (const char c : line) {
    if (c == at)
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

}  // namespace

std::string printable(const std::string& text, std::size_t longest) {
  std::string out;
  bool replaced = false;
  for (const char c : text) {
    if (out.size() >= longest) break;
    const bool good = c >= ' ' && c <= '~';
    if (good || !replaced) out += good ? c : '?';
    replaced = !good;
  }
  return out;
}

std::string to_text(const ImportReport& report) {
  std::string out = std::string(kSchema) + "\n";
  visit_values(report, [&](const char* key, const auto& value) {
    out += std::string(key) + "\t" + shown(value) + "\n";
  });
  for (const ImportReport::Clip& clip : report.clips)
    out += "clip\t" + shown(clip.name) + "\t" + shown(clip.seconds) + "\t" + shown(clip.ticks_per_second) +
           "\t" + shown(clip.frames) + "\t" + shown(clip.driven) + "\n";
  for (const std::size_t component : report.chosen_components) out += "chosen\t" + shown(component) + "\n";
  for (const std::size_t bones : report.component_bones) out += "bones\t" + shown(bones) + "\n";
  for (const std::string& note : report.notes) out += "note\t" + shown(note) + "\n";
  return out;
}

ImportReport parse_report(const std::string& text) {
  const std::vector<std::string> lines = split(text, '\n');
  if (lines.front() != kSchema || !lines.back().empty())
    throw InputError("import report: is not a whole text of " + std::string(kSchema));
  ImportReport report;
  std::map<std::string, std::function<void(const std::string&)>> values;
  visit_values(report, [&](const char* key, auto& value) {
    values[key] = [&value](const std::string& word) { read(word, value); };
  });
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    const std::vector<std::string> words = split(lines[i], '\t');
    const auto need = [&](std::size_t count) {
      if (words.size() != count)
        throw InputError("import report: '" + printable(lines[i]) + "' is cut short");
    };
    if (words[0] == "clip") {
      need(6);
      ImportReport::Clip& clip = report.clips.emplace_back();
      read(words[1], clip.name);
      read(words[2], clip.seconds);
      read(words[3], clip.ticks_per_second);
      read(words[4], clip.frames);
      read(words[5], clip.driven);
    } else if (words[0] == "chosen") {
      need(2);
      read(words[1], report.chosen_components.emplace_back());
    } else if (words[0] == "bones") {
      need(2);
      read(words[1], report.component_bones.emplace_back());
    } else if (words[0] == "note") {
      need(2);
      read(words[1], report.notes.emplace_back());
    } else {
      const auto value = values.find(words[0]);
      if (value == values.end())
        throw InputError("import report: '" + printable(words[0]) + "' is not known");
      need(2);
      value->second(words[1]);
    }
  }
  return report;
}

}  // namespace cscd::scenes
