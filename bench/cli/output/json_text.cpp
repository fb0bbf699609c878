#include "bench/cli/output/json_text.h"

#include <algorithm>

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

void write(const ordered_json& value, std::size_t depth, std::string& out) {
  const bool flat =
      value.empty() || !value.is_structured() ||
      (value.is_array() && std::none_of(value.begin(), value.end(),
                                        [](const ordered_json& item) { return item.is_structured(); }));
  if (flat) {
    out += value.dump();
    return;
  }
  bool first = true;
  out += value.is_object() ? '{' : '[';
  for (const auto& [key, item] : value.items()) {
    if (!first) out += ',';
    first = false;
    out.append("\n").append(depth + 1, ' ');
    if (value.is_object()) out.append(ordered_json(key).dump()).append(": ");
    write(item, depth + 1, out);
  }
  out.append("\n").append(depth, ' ');
  out += value.is_object() ? '}' : ']';
}

}  // namespace

std::string json_text(const ordered_json& value) {
  std::string out;
  write(value, 0, out);
  return out + "\n";
}

}  // namespace cscd::bench
