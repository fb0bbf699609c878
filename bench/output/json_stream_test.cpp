#include "bench/output/json_stream.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

using nlohmann::json;

// Takes a document apart, down to a depth, and writes its parts.
void write(JsonStream& out, const json& value, int depth) {
  if (depth == 0 || !value.is_structured()) {
    out.value(value);
    return;
  }
  value.is_object() ? out.begin_object() : out.begin_array();
  for (const auto& [key, part] : value.items()) {
    if (value.is_object()) out.key(key);
    write(out, part, depth - 1);
  }
  out.end();
}

TEST(JsonStream, WritesWhatADumpOfTheWholeIs) {
  json many = json::array();
  for (int i = 0; i < 20'000; ++i) many.push_back({{"a", i}, {"b", {i, "x\n\"y"}}});
  const json document = {
      {"empty", json::object()}, {"list", json::array()},       {"many", many},
      {"none", nullptr},         {"text", "broken \xff UTF-8"}, {"z", {{{"deep", {1, 2}}}}}};
  const std::string whole = document.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
  for (int depth = 0; depth < 5; ++depth) {
    std::string text;
    std::size_t longest = 0;
    JsonStream out([&](std::string_view piece) {
      text += piece;
      longest = std::max(longest, piece.size());
    });
    write(out, document, depth);
    out.finish();
    EXPECT_EQ(text, whole) << depth;
    if (depth > 0) {
      EXPECT_LT(longest, whole.size() / 4) << "it comes in pieces";
    }
  }
}

}  // namespace
}  // namespace cscd::bench
