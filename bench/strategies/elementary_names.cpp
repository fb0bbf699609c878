#include <charconv>
#include <map>
#include <string>

#include "baselines/fcl/fcl_elementary.h"
#include "bench/strategies/catalogue.h"
#include "bench/strategies/unknown_name.h"

namespace cscd::bench {
namespace {

// Reads the parameters from NAME@TOLERANCE[:STEPS].
TestParameters parsed_parameters(std::string_view name, TestParameters parameters) {
  const auto fail = [&](const std::string& what) {
    throw InputError("elementary test '" + std::string(name) + "': " + what);
  };
  const std::string_view text = name.substr(name.find('@') + 1), tolerance = text.substr(0, text.find(':'));
  if (parameters.tolerance < 0) fail("takes no tolerance; leave out what begins with @");
  const auto read = [](std::string_view digits, auto& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  if (!read(tolerance, parameters.tolerance) || !(parameters.tolerance >= 0 && parameters.tolerance < 1))
    fail("the tolerance is not a number from 0 to less than 1; write it as in @1e-6");
  if (tolerance.size() == text.size()) return parameters;
  if (parameters.steps < 0) fail("takes no number of steps; leave out what begins with :");
  if (!read(text.substr(tolerance.size() + 1), parameters.steps) || parameters.steps < 1)
    fail("the number of steps is not a whole number from 1; write it as in @1e-6:1000");
  return parameters;
}

}  // namespace

std::span<const ElementaryTest> all_elementary_tests() {
  static const std::vector<ElementaryTest> rows = [] {
    const auto own = elementary_tests();
    std::vector<ElementaryTest> all(own.begin(), own.end());
#ifdef CSCD_BASELINES_FCL
    all.push_back(fcl_elementary_test());
#endif
    return all;
  }();
  return rows;
}

const ElementaryTest& elementary_test_named(std::string_view name) {
  static std::map<std::string, ElementaryTest, std::less<>> chosen;
  if (const auto before = chosen.find(name); before != chosen.end()) return before->second;
  const std::string_view row_name = name.substr(0, name.find('@'));
  for (const ElementaryTest& row : all_elementary_tests()) {
    if (row.name != row_name) continue;
    if (row_name == name) return row;
    ElementaryTest with = row;
    with.parameters = parsed_parameters(name, row.parameters);
    const auto place = chosen.emplace(std::string(name), with).first;
    place->second.name = place->first;
    return place->second;
  }
  refuse_unknown("elementary test", name, all_elementary_tests());
}

std::vector<const ElementaryTest*> elementary_tests_named(std::string_view names) {
  std::vector<const ElementaryTest*> rows;
  for (;;) {
    const std::size_t comma = names.find(',');
    const std::string_view name = names.substr(0, comma);
    if (name == "all")
      for (const ElementaryTest& row : all_elementary_tests()) rows.push_back(&row);
    else
      rows.push_back(&elementary_test_named(name));
    if (comma == std::string_view::npos) return rows;
    names.remove_prefix(comma + 1);
  }
}

}  // namespace cscd::bench
