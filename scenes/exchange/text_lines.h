#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "scenes/base/number_word.h"

namespace cscd::scenes {

// The words of a text file, one line after another. A line ends at a line feed, at a carriage return, or at
// both. Where bytes other than text follow, only the end that the caller names counts.
class TextLines {
 public:
  static constexpr std::string_view kAnyEnd = "\r\n", kFeed = "\n", kReturn = "\r";
  explicit TextLines(std::string_view text, std::string_view ends = kAnyEnd)
      : text_(text), ends_(ends), feed_(std::min(text.find('\n'), text.size())) {}

  // Goes to the next line; returns false behind the last.
  bool next() {
    line_ = {};
    if (at_ >= text_.size()) return false;
    const std::size_t end = end_of_line();
    line_ = text_.substr(at_, end - at_);
    at_ = end + 1 + (ends_ == kAnyEnd && text_.substr(end).starts_with("\r\n"));
    ++number_;
    return true;
  }
  // The next word of the line, empty at its end.
  std::string_view word() {
    const auto is_blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    const char* const end = line_.data() + line_.size();
    const char* const from = std::find_if_not(line_.data(), end, is_blank);
    const char* const to = std::find_if(from, end, is_blank);
    line_ = {to, static_cast<std::size_t>(end - to)};
    return {from, static_cast<std::size_t>(to - from)};
  }
  void leave_line() { line_ = {}; }
  // Where the next line begins, and the number of this line, which counts from 1.
  std::size_t position() const { return std::min(at_, text_.size()); }
  std::size_t line_number() const { return number_; }
  void count_from(std::size_t number) { number_ = number; }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("line " + std::to_string(number_) + ": " + what + "; export the file again");
  }
  // The start of a word, with a question mark for each byte that is no letter, digit or mark.
  static std::string quoted(std::string_view word) {
    std::string shown(word.substr(0, 40));
    for (char& c : shown)
      if (c < ' ' || c > '~') c = '?';
    return "'" + shown + "'";
  }

  // Returns the number that a word is; `what` names it where it is none or is not finite.
  double number(std::string_view word, const char* what) const {
    const std::optional<double> value = number_of(word);
    if (!value) fail(quoted(word) + " is no " + what);
    if (!std::isfinite(*value)) fail(std::string("a ") + what + " is not finite");
    return *value;
  }

 private:
  // Looks for each line feed once: a file whose lines end by carriage returns may have none.
  std::size_t end_of_line() {
    if (ends_ == kReturn) return std::min(text_.find('\r', at_), text_.size());
    if (feed_ < at_) feed_ = std::min(text_.find('\n', at_), text_.size());
    return ends_ == kFeed ? feed_ : std::min(text_.substr(0, feed_).find('\r', at_), feed_);
  }

  std::string_view text_, ends_, line_;
  std::size_t feed_;  // the next line feed, or the end of the text
  std::size_t at_ = 0, number_ = 0;
};

}  // namespace cscd::scenes
