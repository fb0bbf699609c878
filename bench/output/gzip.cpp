#include "bench/output/gzip.h"

#include <stdexcept>
#include <zlib.h>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

constexpr int kLargestWindow = 15;
constexpr int kGzipWindow = kLargestWindow + 16;  // zlib's way to ask for a gzip header
constexpr std::size_t kBlock = std::size_t{1} << 16;

bool is_gzip(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

z_stream stream_over(std::string_view bytes) {
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  return stream;
}

void begin_to_compress(z_stream& stream, int level, int window) {
  if (deflateInit2(&stream, level, Z_DEFLATED, window, 9, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("zlib cannot begin to compress");
}

std::string compressed(std::string_view bytes, int level, int window) {
  z_stream stream = stream_over(bytes);
  begin_to_compress(stream, level, window);
  std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int state = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (state != Z_STREAM_END) throw std::runtime_error("zlib cannot compress");
  return out;
}

}  // namespace

struct GzipStream::State {
  z_stream stream{};
};

GzipStream::GzipStream() : state_(std::make_unique<State>()) {
  begin_to_compress(state_->stream, Z_BEST_COMPRESSION, kGzipWindow);
}

GzipStream::~GzipStream() {
  deflateEnd(&state_->stream);
}

std::string GzipStream::add(std::string_view piece, bool is_last) {
  z_stream& stream = state_->stream;
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
  stream.avail_in = static_cast<uInt>(piece.size());
  std::string out;
  do {
    const std::size_t before = out.size();
    out.resize(before + kBlock);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = static_cast<uInt>(kBlock);
    if (deflate(&stream, is_last ? Z_FINISH : Z_NO_FLUSH) == Z_STREAM_ERROR)
      throw std::runtime_error("zlib cannot compress");
    out.resize(before + kBlock - stream.avail_out);
  } while (stream.avail_out == 0);
  return out;
}

std::string gzipped(std::string_view text) {
  return compressed(text, Z_BEST_COMPRESSION, kGzipWindow);
}

std::string deflated(std::string_view bytes) {
  return compressed(bytes, Z_DEFAULT_COMPRESSION, kLargestWindow);
}

std::string without_gzip(std::string bytes, const std::string& where, std::size_t most_bytes) {
  if (!is_gzip(bytes)) return bytes;
  z_stream stream = stream_over(bytes);
  if (inflateInit2(&stream, kGzipWindow) != Z_OK) throw std::runtime_error("zlib cannot begin to unpack");
  std::string out;
  int state = Z_OK;
  while (state == Z_OK && out.size() <= most_bytes) {
    const std::size_t before = out.size();
    out.resize(before + kBlock);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    stream.avail_out = static_cast<uInt>(kBlock);
    state = inflate(&stream, Z_NO_FLUSH);
    out.resize(before + kBlock - stream.avail_out);
  }
  inflateEnd(&stream);
  if (out.size() > most_bytes)
    throw InputError(where + ": holds more than " + std::to_string(most_bytes >> 20) + " MiB once unpacked");
  if (state != Z_STREAM_END) throw InputError(where + ": is a damaged gzip file");
  return out;
}

}  // namespace cscd::bench
