// Elementary tests against the oracle.
#include <cmath>

#include "core/elementary/catalogue.h"
#include "core/elementary/exact/exact.h"
#include "fuzz/numbers.h"

namespace cscd::fuzz {
namespace {

template <class Query>
void judge(const Query& query) {
  const auto truth = exact::first_contact(query);
  for (const ElementaryTest& row : elementary_tests()) {
    const Answer answer = row.answer(query);
    const std::string name(row.name);
    if (answer.verdict != Verdict::apart && !(answer.time >= 0 && answer.time <= 1))
      broken(name + " gives a time outside the interval");
    if (truth && row.apart_is_proof) {
      if (answer.verdict == Verdict::apart) broken(name + " loses a contact");
      if (answer.time > truth->hi) broken(name + " is late");
      if (row.contact_is_proof && answer.verdict == Verdict::contact &&
          std::abs(answer.time - truth->lo) > 1e-12)
        broken(name + " gives another time than the oracle");
    }
    if (!truth && row.contact_is_proof && answer.verdict == Verdict::contact)
      broken(name + " invents a contact");
  }
}

}  // namespace

void target(Bytes bytes) {
  Numbers numbers(bytes);
  MovingPoint points[4];
  for (MovingPoint& point : points) point = {numbers.point(), numbers.point()};
  judge(MovingVertexFace{points[0], {points[1], points[2], points[3]}});
  judge(MovingEdgeEdge{{points[0], points[1]}, {points[2], points[3]}});
}

}  // namespace cscd::fuzz
