#include "bench/output/markdown.h"

#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

std::string line(std::span<const std::string> cells) {
  return "| " + joined(cells, " | ") + " |\n";
}

}  // namespace

std::string markdown_table(std::span<const std::string> head,
                           std::span<const std::vector<std::string>> rows) {
  std::string out = line(head) + "|---|";
  for (std::size_t i = 1; i < head.size(); ++i) out += "---:|";
  out += "\n";
  for (const std::vector<std::string>& row : rows) out += line(row);
  return out;
}

}  // namespace cscd::bench
