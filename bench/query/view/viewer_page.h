#pragma once

#include <string_view>

namespace cscd::bench {

// The viewer as one HTML page without data, bundled from the folder page/ when the program is built. Empty if
// CMake was told to build without it (CSCD_VIEWER=OFF).
std::string_view viewer_page();

// The page of cscd report, likewise.
std::string_view report_page();

// The place in a page that the data take.
inline constexpr std::string_view kDataPlace = "<!--data-->";

}  // namespace cscd::bench
