#pragma once

#include <string_view>

namespace cscd::scenes {

// Returns a text file's bytes without the byte order mark that programs on Windows write before UTF-8. Throws
// InputError for text in UTF-16 or UTF-32, which those programs write too.
std::string_view without_byte_order_mark(std::string_view bytes);

}  // namespace cscd::scenes
