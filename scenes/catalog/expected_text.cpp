#include "scenes/catalog/expected_text.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

using OrderedJson = nlohmann::ordered_json;

// A half-open range of bytes; empty where nothing was found.
struct Span {
  std::size_t begin = 0, end = 0;
};

// Finds the value of the last member `expected` of the outermost object, in a text that is known to be JSON.
Span find_value(const std::string& text) {
  Span found;
  std::size_t depth = 0, key_begin = 0, value_begin = 0;
  bool in_text = false;
  std::string key;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text) {
      if (c == '\\') ++i;
      if (c != '"') continue;
      in_text = false;
      if (value_begin == 0) key = text.substr(key_begin, i - key_begin);
      continue;
    }
    if (c == '"') in_text = true, key_begin = i + 1;
    if (c == ':' && depth == 1) value_begin = text.find_first_not_of(" \t\r\n", i + 1);
    const bool closes = c == '}' || c == ']';
    if ((c == ',' || closes) && depth == 1) {
      if (value_begin != 0 && key == "expected")
        found = {value_begin, text.find_last_not_of(" \t\r\n", i - 1) + 1};
      value_begin = 0;
    }
    if (c == '{' || c == '[') ++depth;
    if (closes) --depth;
  }
  return found;
}

}  // namespace

std::string with_expected(const std::string& text, const Expected& expected, const std::string& where) {
  try {
    OrderedJson wanted = OrderedJson::parse(text);
    if (!wanted.is_object()) throw InputError(where + ": must be an object");
    wanted["expected"] = {{"vertices", expected.vertices.value()},
                          {"triangles", expected.triangles.value()},
                          {"bones", expected.bones.value()},
                          {"digest", expected.digest.value()}};
    const std::string value = "{\"vertices\": " + std::to_string(*expected.vertices) +
                              ", \"triangles\": " + std::to_string(*expected.triangles) +
                              ", \"bones\": " + std::to_string(*expected.bones) +
                              ", \"digest\": " + OrderedJson(*expected.digest).dump() + "}";
    std::string changed = text;
    if (const Span old = find_value(text); old.end > 0) {
      changed.replace(old.begin, old.end - old.begin, value);
    } else {
      const std::size_t brace = text.rfind('}'), last = text.find_last_not_of(" \t\r\n", brace - 1);
      const bool first_member = text[last] == '{';
      changed.insert(last + 1, std::string(first_member ? "" : ",") + "\n  \"expected\": " + value);
    }
    // If the edited text does not have the wanted meaning, because the file is written in an unforeseen
    // way, the whole text is written anew: the file loses its white space and keeps its meaning.
    return OrderedJson::parse(changed, nullptr, false) == wanted ? changed : wanted.dump(2) + "\n";
  } catch (const OrderedJson::exception& error) {
    throw InputError(where + ": is not JSON: " + error.what());
  }
}

}  // namespace cscd::scenes
