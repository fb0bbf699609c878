#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace cscd::bench {

// Adds a name unless it is there.
template <class Name>
void add_new(std::vector<std::string>& names, const Name& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

// The names of the parts, each once, in the order in which they first occur.
template <class Parts, class Name>
std::vector<std::string> distinct(const Parts& parts, const Name& name) {
  std::vector<std::string> names;
  for (const auto& part : parts) add_new(names, name(part));
  return names;
}

}  // namespace cscd::bench
