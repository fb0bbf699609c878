#include "scenes/character/report.h"

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <string_view>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/split.h"

namespace cscd::scenes {
namespace {

constexpr char kSchema[] = "cscd.import/3";

std::string shown(double value) {
  return exact_text(value);
}
std::string shown(std::integral auto value) {
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

// Calls `visit` with the name and the value of every single value of a report. Both writing and
// reading use this one list.
template <class Report, class Visit>
void visit_values(Report& r, Visit&& visit) {
  visit("format", r.format);
  visit("up", r.up);
  visit("centimetres_per_unit", r.centimetres_per_unit);
  visit("nodes", r.nodes);
  visit("meshes", r.meshes);
  visit("joints", r.joints);
  visit("vertices", r.vertices);
  visit("triangles", r.triangles);
  visit("most_influences", r.most_influences);
  visit("chosen_clip", r.chosen_clip);
  visit("fps", r.fps);
  visit("fps_from", r.fps_from);
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

// Returns the length in bytes of the UTF-8 character at the start of `text`. Returns 0 where the text
// starts with no whole character, or with a character that controls a terminal or the direction of writing.
std::size_t printable_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return byte(0) >= ' ' && byte(0) != 0x7f ? 1 : 0;
  const std::size_t length = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  if (byte(0) < 0xc2 || byte(0) > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = byte(0) & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  constexpr std::uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool valid = code >= least[length] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  const bool control = code < 0xa0 || code == 0xfeff || (code >= 0x200b && code <= 0x200f) ||
                       (code >= 0x2028 && code <= 0x202e) || (code >= 0x2060 && code <= 0x206f);
  return valid && !control ? length : 0;
}

}  // namespace

std::string printable(const std::string& text, std::size_t longest) {
  std::string out;
  bool replaced = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = printable_character(std::string_view(text).substr(at));
    if (out.size() + std::max<std::size_t>(length, 1) > longest) break;
    if (length > 0 || !replaced) out += length > 0 ? text.substr(at, length) : "?";
    replaced = length == 0;
    at += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string to_text(const ImportReport& report) {
  std::string out = std::string(kSchema) + "\n";
  visit_values(report, [&](const char* key, const auto& value) {
    out += std::string(key) + "\t" + shown(value) + "\n";
  });
  for (const ImportReport::Clip& clip : report.clips)
    out += "clip\t" + shown(clip.name) + "\t" + shown(clip.start) + "\t" + shown(clip.seconds) + "\t" +
           shown(clip.ticks_per_second) + "\t" + shown(clip.frames) + "\t" + shown(clip.driven) + "\t" +
           shown(clip.first_frame) + "\n";
  for (const ImportReport::Part& part : report.parts)
    out += "part\t" + shown(part.name) + "\t" + shown(part.node) + "\t" + shown(part.mesh) + "\t" +
           shown(part.primitive) + "\n";
  for (const std::string& bone : report.bones) out += "bone\t" + shown(bone) + "\n";
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
      need(8);
      ImportReport::Clip& clip = report.clips.emplace_back();
      read(words[1], clip.name);
      read(words[2], clip.start);
      read(words[3], clip.seconds);
      read(words[4], clip.ticks_per_second);
      read(words[5], clip.frames);
      read(words[6], clip.driven);
      read(words[7], clip.first_frame);
    } else if (words[0] == "part") {
      need(5);
      ImportReport::Part& part = report.parts.emplace_back();
      read(words[1], part.name);
      read(words[2], part.node);
      read(words[3], part.mesh);
      read(words[4], part.primitive);
    } else if (words[0] == "bone") {
      need(2);
      read(words[1], report.bones.emplace_back());
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
