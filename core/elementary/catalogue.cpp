#include <array>

#include "core/elementary/elementary_test.h"
#include "core/elementary/exact.h"
#include "core/elementary/filter.h"
#include "core/elementary/newton.h"
#include "core/elementary/relative_box.h"

namespace cscd {
namespace {

// The referee behind two certified filters: their "apart" is a proof, so the answers are the referee's.
template <class Query>
Answer filtered_referee(const Query& query) {
  if (never_coplanar(query) || relative_boxes_apart(query)) return {Verdict::apart, 0};
  const auto time = exact::first_contact(query);
  return time ? Answer{Verdict::contact, time->lo} : Answer{Verdict::apart, 0};
}

constexpr std::array kTests = {
    ElementaryTest{"newton",
                   "non-penetration filter (Tang et al. 2010) and interval Newton, double precision", false,
                   false, newton_vertex_face, newton_edge_edge},
    ElementaryTest{"exact", "the referee: exact arithmetic behind certified filters", true, true,
                   filtered_referee, filtered_referee},
};

}  // namespace

std::span<const ElementaryTest> elementary_tests() {
  return kTests;
}

const ElementaryTest* find_elementary_test(std::string_view name) {
  for (const ElementaryTest& test : kTests)
    if (test.name == name) return &test;
  return nullptr;
}

}  // namespace cscd
