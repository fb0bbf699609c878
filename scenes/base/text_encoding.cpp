#include "scenes/base/text_encoding.h"

#include <string>

#include "core/base/error.h"

namespace cscd::scenes {

std::string_view without_byte_order_mark(std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool wide = bytes.starts_with("\0\0\xFE\xFF"sv) || bytes.starts_with("\xFF\xFE\0\0"sv);
  // Text of these formats begins with letters that need one byte each, beside which UTF-16 has a zero byte.
  // A zero byte among other text is not taken for it: every second byte is zero of the first two letters.
  const auto zero_beside_letter = [&](std::size_t at) {
    return bytes.size() < at + 2 || (bytes[at] == '\0') != (bytes[at + 1] == '\0');
  };
  const bool every_second_zero = bytes.size() >= 2 && zero_beside_letter(0) && zero_beside_letter(2);
  if (wide || bytes.starts_with("\xFE\xFF"sv) || bytes.starts_with("\xFF\xFE"sv) || every_second_zero)
    throw InputError(std::string("is text in UTF-") + (wide ? "32" : "16") +
                     ", of which only UTF-8 and ASCII are read; save it as UTF-8");
  if (bytes.starts_with("\xEF\xBB\xBF"sv)) bytes.remove_prefix(3);
  return bytes;
}

}  // namespace cscd::scenes
