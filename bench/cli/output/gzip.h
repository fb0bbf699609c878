#pragma once

#include <string>
#include <string_view>

namespace cscd::bench {

// Compresses a text as a gzip file (RFC 1952). The same text gives the same bytes: no time or name is stored.
std::string gzipped(std::string_view text);

// Compresses bytes in the zlib format (RFC 1950), which browsers inflate as `deflate`.
std::string deflated(std::string_view bytes);

// Returns the text of a gzip file, or `bytes` themselves where they are none. Throws InputError, which
// `where` begins, for a gzip file that is damaged or that holds more than `most_bytes`.
std::string without_gzip(std::string bytes, const std::string& where, std::size_t most_bytes);

}  // namespace cscd::bench
