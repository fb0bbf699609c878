#include "bench/query/view/sections.h"

#include <cstdint>

#include "bench/output/gzip.h"

namespace cscd::bench {

void Sections::add_bytes(const std::string& name, const std::string& type, std::string_view raw) {
  const std::string packed = deflated(raw);
  table_.push_back({{"name", prefix_ + name},
                    {"type", type},
                    {"raw", raw.size()},
                    {"offset", bytes_.size()},
                    {"bytes", packed.size()}});
  bytes_ += packed;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::string_view three = bytes.substr(i, 3);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < three.size() ? static_cast<std::uint8_t>(three[k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= three.size() ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

}  // namespace cscd::bench
