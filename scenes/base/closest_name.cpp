#include "scenes/base/closest_name.h"

#include <algorithm>
#include <vector>

namespace cscd {
namespace {

constexpr std::size_t kLongest = 64;  // length of the words that are compared; the time grows with its square

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between the first i letters of a and the first j letters of b.
  // The last three rows are enough.
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::string_view closest_name(std::string_view word, std::span<const std::string_view> names) {
  std::string_view closest;
  if (word.size() > kLongest) return closest;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string_view name : names) {
    if (name.size() > kLongest) continue;
    if (const std::size_t distance = edit_distance(word, name); distance < least)
      least = distance, closest = name;
  }
  return closest;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> names) {
  const std::string_view closest = closest_name(word, names);
  return closest.empty() ? "" : "; did you mean " + std::string(closest) + "?";
}

}  // namespace cscd
