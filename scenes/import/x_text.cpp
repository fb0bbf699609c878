#include "scenes/import/x_text.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "scenes/base/number_word.h"
#include "scenes/base/text_encoding.h"

namespace cscd::scenes {
namespace {

constexpr std::string_view kDigits = "0123456789", kBetween = " \t\r\n;,{}\"<";

bool begins_like_number(std::string_view word) {
  if (word.starts_with('-') || word.starts_with('+')) word.remove_prefix(1);
  if (word.starts_with('.')) word.remove_prefix(1);
  return !word.empty() && kDigits.find(word.front()) != kDigits.npos;
}

class XText {
 public:
  explicit XText(std::string_view text) : text_(text) {}

  void check() {
    for (char before = ' '; at_ < text_.size();) {
      const char c = text_[at_];
      if (c == '"') {
        go_behind("\"", at_ + 1);
      } else if (c == '<') {  // the number of a template
        go_behind(">", at_ + 1);
      } else if (c == '#' || text_.substr(at_).starts_with("//")) {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else if (kBetween.find(c) != kBetween.npos) {
        if (c == '{' || c == '}') before = c;
        ++at_;
      } else {
        check_word(before);
        before = ' ';
      }
    }
  }

 private:
  void go_behind(std::string_view end, std::size_t from) {
    at_ = std::min(text_.find(end, from), text_.size() - 1) + 1;
  }

  // A word before a brace, or between two, is a name, whatever it looks like.
  void check_word(char before) {
    const std::size_t end = std::min(text_.find_first_of(kBetween, at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    const std::size_t next = std::min(text_.find_first_not_of(" \t\r\n", end), text_.size());
    const bool is_name = next < text_.size() && (text_[next] == '{' || (text_[next] == '}' && before == '{'));
    const std::optional<double> number = number_of(word);
    if (!is_name && (number ? !std::isfinite(*number) : begins_like_number(word)))
      throw InputError("line " + std::to_string(1 + std::ranges::count(text_.substr(0, at_), '\n')) + ": '" +
                       std::string(word.substr(0, 40)) +
                       "' stands where a number has to be; export the file again");
    at_ = end;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string_view checked_x(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  constexpr std::size_t kHeader = 16;  // "xof 0303txt 0032"
  if (bytes.size() >= kHeader && bytes.starts_with("xof ") && bytes.substr(8, 4) == "txt ")
    XText(bytes.substr(kHeader)).check();
  return bytes;
}

}  // namespace cscd::scenes
