#include "core/session/interval_verdict.h"

namespace cscd {

std::string_view to_string(IntervalVerdict verdict) {
  switch (verdict) {
    case IntervalVerdict::clear:
      return "clear";
    case IntervalVerdict::touches:
      return "touches";
    case IntervalVerdict::intersects_at_start:
      return "intersects_at_start";
    case IntervalVerdict::undecided:
      return "undecided";
    case IntervalVerdict::close:
      return "close";
  }
  return "";
}

}  // namespace cscd
