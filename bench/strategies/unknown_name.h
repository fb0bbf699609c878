#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "scenes/base/closest_name.h"
#include "scenes/base/joined.h"

namespace cscd::bench {

// Throws InputError that lists the names of the rows, where `name` is none of them. An elementary test may be
// followed by @ and its parameters.
template <class Rows>
[[noreturn]] void refuse_unknown(const char* what, std::string_view name, const Rows& rows) {
  std::vector<std::string_view> names;
  for (const auto& row : rows) names.push_back(row.name);
  throw InputError(std::string(what) + " '" + std::string(name) + "' is not known" +
                   did_you_mean(name.substr(0, name.find('@')), names) + "; choose one of " + joined(names));
}

}  // namespace cscd::bench
