#include "bench/harness/interval_choice.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace cscd::bench {

std::vector<std::size_t> every_kth(const IntervalRange& range, std::size_t k) {
  std::vector<std::size_t> intervals;
  for (std::size_t i = range.first; i < range.last; i += k) intervals.push_back(i);
  return intervals;
}

std::vector<std::size_t> spread(std::size_t count, std::size_t over) {
  count = std::min(count, over);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back((2 * k + 1) * over / (2 * count));
  return out;
}

std::vector<std::size_t> intervals_with_contacts(Input& input, Detector& detector,
                                                 const IntervalRange& range) {
  std::vector<std::size_t> touching;
  ContactSet found;
  for (std::size_t i = range.first; i < range.last; ++i) {
    const scenes::ClipInterval interval = input.clip->load(i);
    detector.detect(input.step(interval), found);
    if (!found.contacts.empty()) touching.push_back(i);
  }
  return touching;
}

std::vector<std::size_t> with_contacts(std::span<const std::size_t> chosen,
                                       std::span<const std::size_t> touching, std::size_t count) {
  std::vector<std::size_t> all(chosen.begin(), chosen.end()), others;
  std::ranges::set_difference(touching, chosen, std::back_inserter(others));
  const std::size_t there = touching.size() - others.size();
  const std::size_t missing = std::min(count > there ? count - there : 0, others.size());
  for (const std::size_t place : spread(missing, others.size())) all.push_back(others[place]);
  std::ranges::sort(all);
  return all;
}

std::vector<std::size_t> united(std::span<const std::vector<std::size_t>> sets) {
  std::set<std::size_t> all;
  for (const std::vector<std::size_t>& set : sets) all.insert(set.begin(), set.end());
  return {all.begin(), all.end()};
}

}  // namespace cscd::bench
