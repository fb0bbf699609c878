#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/output/schema.h"
#include "bench/testing/test_generated.h"
#include "bench/testing/test_shell.h"

namespace cscd::bench {

// What a page of the viewer knows of its input, apart from arrays.
inline nlohmann::json header_of(const std::string& page) {
  const std::string begin = "id=\"header\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

// The program with a character to ask about, figure.glb.
class QueryProgram : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    put("figure.glb", scenes::to_glb(scenes::walking_figure()));
  }
  // The answer of query as JSON, which has to keep to the schema.
  nlohmann::json answer(const std::string& words) const {
    const Ran ran = run("cscd query " + words + " --json -");
    EXPECT_EQ(ran.status, 0) << words << ": " << ran.errors;
    const auto document = nlohmann::ordered_json::parse(ran.out);
    EXPECT_EQ(schema_violation(document, "query.schema.json"), "") << words;
    return nlohmann::json(document);
  }
  // An answer without the milliseconds that it took.
  static nlohmann::json timeless(nlohmann::json document) {
    document["summary"].erase("ms");
    for (nlohmann::json& interval : document["intervals"]) interval.erase("ms");
    return document;
  }
};

}  // namespace cscd::bench
