#include <cmath>

#include "core/base/error.h"
#include "scenes/base/number_word.h"
#include "scenes/import/collada/parts.h"

namespace cscd::scenes::collada {

std::size_t numbers_of_transform(std::string_view name) {
  constexpr struct {
    std::string_view name;
    std::size_t numbers;
  } kTransforms[] = {{"matrix", 16}, {"rotate", 4}, {"translate", 3},
                     {"scale", 3},   {"lookat", 9}, {"skew", 7}};
  for (const auto& row : kTransforms)
    if (row.name == name) return row.numbers;
  return 0;
}

namespace {

void check_transforms(pugi::xml_node node) {
  for (const pugi::xml_node element : node.children()) {
    const std::size_t wanted = numbers_of_transform(element.name());
    if (wanted == 0) continue;
    const std::vector<double> numbers = numbers_of(element);
    if (numbers.size() != wanted)
      throw InputError(told(element) + ": has " + std::to_string(numbers.size()) + " numbers instead of " +
                       std::to_string(wanted) + "; export it again");
    if (element.name() == std::string_view("skew"))
      throw InputError(told(element) + ": skewed nodes are not read; bake the transforms on export");
  }
}

}  // namespace

void check_nodes(const Document& document) {
  for (const char* library : {"library_visual_scenes", "library_nodes"})
    for (const pugi::xml_node in : document.root().children(library))
      walk(in, [](pugi::xml_node element) {
        if (element.name() == std::string_view("node") || element.name() == std::string_view("visual_scene"))
          check_transforms(element);
      });
  const pugi::xml_attribute metres = document.root().child("asset").child("unit").attribute("meter");
  if (!metres) return;
  const std::optional<double> unit = number_of(metres.value());
  if (!unit || !std::isfinite(*unit) || *unit <= 0)
    throw InputError("<unit>: its length of '" + std::string(metres.value()).substr(0, 40) +
                     "' metres is no positive number; repair it");
}

}  // namespace cscd::scenes::collada
