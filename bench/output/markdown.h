#pragma once

#include <span>
#include <string>
#include <vector>

namespace cscd::bench {

// A table in Markdown: the first column to the left, the others to the right. Each row has as many cells as
// the head.
std::string markdown_table(std::span<const std::string> head, std::span<const std::vector<std::string>> rows);

}  // namespace cscd::bench
