#include "scenes/base/text_encoding.h"

#include <string>

#include "core/base/error.h"

namespace cscd::scenes {

std::string_view without_byte_order_mark(std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool wide = bytes.starts_with("\0\0\xFE\xFF"sv) || bytes.starts_with("\xFF\xFE\0\0"sv);
  // Text of these formats begins with letters that need one byte each, beside which UTF-16 has a zero byte.
  const bool zero_beside_letter = bytes.size() >= 2 && (bytes[0] == '\0') != (bytes[1] == '\0');
  if (wide || bytes.starts_with("\xFE\xFF"sv) || bytes.starts_with("\xFF\xFE"sv) || zero_beside_letter)
    throw InputError(std::string("is text in UTF-") + (wide ? "32" : "16") +
                     ", of which only UTF-8 and ASCII are read; save it as UTF-8");
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
  return bytes;
}

}  // namespace cscd::scenes
