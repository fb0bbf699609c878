#include "core/detect/strategy.h"

namespace cscd {

std::string_view to_string(Guarantee guarantee) {
  switch (guarantee) {
    case Guarantee::complete:
      return "complete";
    case Guarantee::first_contact:
      return "first_contact";
    case Guarantee::all_from_embedded:
      return "all_from_embedded";
    case Guarantee::heuristic:
      return "heuristic";
  }
  return "";
}

}  // namespace cscd
