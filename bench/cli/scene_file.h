#pragma once

#include <span>
#include <string>

#include "scenes/shape/parameters.h"

// What a scene file may hold: its members, and the parameters of every shape and effect. All of it comes from
// the rows by which scene files are read (scene_fields, ShapeRow, EffectRow).
namespace cscd::bench {

// Parameters as a plain text for a terminal: a line of facts and the meaning each, from a column on.
std::string parameters_text(std::span<const scenes::ParameterRow> rows, std::size_t indent);

// Everything, for a terminal and as the page scenes/README.md.
std::string scene_file_text();
std::string scene_file_markdown();

}  // namespace cscd::bench
