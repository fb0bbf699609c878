#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace cscd::bench {

// Compresses a text as a gzip file (RFC 1952). The same text gives the same bytes: no time or name is stored.
std::string gzipped(std::string_view text);

// Compresses a text that comes in pieces, to the bytes that gzipped() makes of the whole.
class GzipStream {
 public:
  GzipStream();
  ~GzipStream();
  GzipStream(const GzipStream&) = delete;
  GzipStream& operator=(const GzipStream&) = delete;

  // Returns what follows in the file once the next piece, or with `is_last` all of the text, is known.
  std::string add(std::string_view piece, bool is_last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Compresses bytes in the zlib format (RFC 1950), which browsers inflate as `deflate`.
std::string deflated(std::string_view bytes);

// Returns the text of a gzip file, or `bytes` themselves where they are none. Throws InputError, which
// `where` begins, for a gzip file that is damaged or that holds more than `most_bytes`.
std::string without_gzip(std::string bytes, const std::string& where, std::size_t most_bytes);

}  // namespace cscd::bench
