#include "scenes/import/x_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

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

// Follows the numbers of a mesh: how many vertices, three numbers for each, how many faces, and for each face
// how many corners and which vertices they are. assimp leaves corners out whose vertex does not exist.
class MeshNumbers {
 public:
  MeshNumbers() = default;
  explicit MeshNumbers(std::string_view name) : name_(name), next_(Next::vertices) {}

  void take(std::string_view word) {
    if (next_ == Next::none) return;
    if (next_ == Next::position) {
      if (--left_ == 0) next_ = Next::faces;
      return;
    }
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool whole = error == std::errc{} && end == word.data() + word.size();
    if (next_ == Next::corner && (!whole || number < 0 || number >= vertices_))
      throw InputError("mesh '" + std::string(name_) + "', face " + std::to_string(face_) +
                       " (counted from 0): names vertex " + std::string(word.substr(0, 40)) + " of " +
                       std::to_string(vertices_) + "; repair it or export the file again");
    if (!whole || number < 0 || number > UINT32_MAX)
      next_ = Next::none;  // no mesh but its template, or what assimp refuses
    else
      take_number(number);
  }

  // How many vertices of a mesh that was read to its end are of no face.
  std::size_t loose() const {
    return next_ == Next::none && faces_ > 0 && face_ == faces_
               ? static_cast<std::size_t>(std::ranges::count(used_, false))
               : 0;
  }

 private:
  enum class Next { none, vertices, position, faces, corners, corner };

  void take_number(std::int64_t number) {
    switch (next_) {
      case Next::vertices:
        vertices_ = number;
        left_ = 3 * number;
        next_ = number > 0 ? Next::position : Next::faces;
        return;
      case Next::faces:
        faces_ = number;
        used_.resize(static_cast<std::size_t>(vertices_));  // the text has been as long as that
        next_ = number > 0 ? Next::corners : Next::none;
        return;
      case Next::corners:
        left_ = number;
        next_ = Next::corner;
        break;
      case Next::corner:
        used_[static_cast<std::size_t>(number)] = true;
        --left_;
        break;
      case Next::none:
      case Next::position:
        return;
    }
    if (left_ == 0) next_ = ++face_ < faces_ ? Next::corners : Next::none;
  }

  std::string_view name_;
  Next next_ = Next::none;
  std::int64_t vertices_ = 0, faces_ = 0, face_ = 0;
  std::int64_t left_ = 0;  // numbers of positions, or corners of the face
  std::vector<bool> used_;
};

// Follows the numbers of an animation's keys: their kind, how many keys, and for each key its time, how many
// values, and these. assimp takes a comma for a decimal point.
class KeyNumbers {
 public:
  void begin() { left_ = 2, next_ = Next::head; }

  // Takes the next word, which stands behind `between`. Returns whether it is one value too many.
  bool take(std::string_view word, std::string_view between) {
    if (next_ == Next::none) return false;
    if (next_ == Next::head) {
      if (--left_ == 0) next_ = Next::time;
    } else if (next_ == Next::time) {
      next_ = Next::values;
      return has_values_ && between.find(';') == between.npos;
    } else if (next_ == Next::values) {
      left_ = 0;
      std::from_chars(word.data(), word.data() + word.size(), left_);
      has_values_ = left_ > 0;
      next_ = left_ > 0 ? Next::value : Next::time;
    } else if (--left_ == 0) {
      next_ = Next::time;
    }
    return false;
  }

 private:
  enum class Next { none, head, time, values, value };
  Next next_ = Next::none;
  std::int64_t left_ = 0;
  bool has_values_ = false;  // of a key before
};

class XText {
 public:
  explicit XText(std::string_view text) : text_(text) {}

  // Returns how many vertices are of no face.
  std::size_t check() {
    std::size_t loose = 0;
    for (char before = ' '; at_ < text_.size();) {
      const char c = text_[at_];
      if (c == '"') {
        go_behind("\"", at_ + 1);
      } else if (c == '<') {  // the number of a template
        go_behind(">", at_ + 1);
      } else if (c == '#' || text_.substr(at_).starts_with("//")) {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else if (kBetween.find(c) != kBetween.npos) {
        if (c == '{' || c == '}') {
          before = c;
          loose += mesh_.loose();
          mesh_ = {};
          keys_ = {};
          if (c == '{') begin_block();
          last_ = last_but_one_ = {};
        }
        ++at_;
      } else {
        check_word(before);
        before = ' ';
      }
    }
    return loose;
  }

 private:
  // A kind and, as the file likes, a name stand before a brace. Other things may have the name Mesh.
  void begin_block() {
    if (last_ == "AnimationKey" || last_but_one_ == "AnimationKey") keys_.begin();
    if (last_but_one_ == "Mesh")
      mesh_ = MeshNumbers(last_);
    else if (last_ == "Mesh" && (last_but_one_.empty() || begins_like_number(last_but_one_)))
      mesh_ = MeshNumbers("");
  }

  // The line of the next word, to begin a refusal with.
  std::string line() const {
    return "line " + std::to_string(1 + std::ranges::count(text_.substr(0, at_), '\n'));
  }

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
      throw InputError(line() + ": '" + std::string(word.substr(0, 40)) +
                       "' stands where a number has to be; export the file again");
    if (number && keys_.take(word, text_.substr(behind_, at_ - behind_)))
      throw InputError(line() + ": an animation key has more values than it counts; export the file again");
    at_ = behind_ = end;
    mesh_.take(word);
    last_but_one_ = last_;
    last_ = word;
  }

  std::string_view text_;
  std::size_t at_ = 0, behind_ = 0;       // behind the last word
  std::string_view last_, last_but_one_;  // the words since the last brace
  MeshNumbers mesh_;
  KeyNumbers keys_;
};

}  // namespace

CheckedX checked_x(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  constexpr std::size_t kHeader = 16;  // "xof 0303txt 0032"
  if (bytes.size() >= kHeader && bytes.starts_with("xof ") && bytes.substr(8, 4) == "txt ")
    return {bytes, XText(bytes.substr(kHeader)).check()};
  return {bytes, 0};
}

}  // namespace cscd::scenes
