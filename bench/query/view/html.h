#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "bench/query/view/sections.h"

namespace cscd::bench {

// Puts data into a page of the viewer: `header`, which any text may stand in, and arrays of numbers.
std::string viewer_with(std::string_view page, const nlohmann::json& header, const Sections& sections);

// Whether a page of the viewer stands there, which names the viewer in its head. Such a page can be made
// again.
bool is_page_of_viewer(const std::filesystem::path& path);

// Puts a JSON document into the page of the report. Throws as viewer_with() does.
std::string report_with(const nlohmann::json& document);

// Throws InputError if the program was built without the viewer and the report.
void require_viewer();

}  // namespace cscd::bench
