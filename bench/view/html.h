#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bench/view/sections.h"

namespace cscd::bench {

// Puts data into the viewer's page: `header`, which any text may stand in, and arrays of numbers. Throws
// InputError if the program was built without the viewer.
std::string viewer_with(const nlohmann::json& header, const Sections& sections);

// Puts a JSON document into the page of the report. Throws as viewer_with() does.
std::string report_with(const nlohmann::json& document);

// Throws InputError if the program was built without the viewer and the report.
void require_viewer();

}  // namespace cscd::bench
