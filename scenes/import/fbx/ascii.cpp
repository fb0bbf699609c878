#include <algorithm>

#include "core/base/error.h"
#include "scenes/import/fbx/document.h"

namespace cscd::scenes::fbx {
namespace {

constexpr std::string_view kBlanks = " \t\r\n", kLineEnds = "\r\n";
// The version stands in the first of these bytes.
constexpr std::size_t kHead = 8192;

// Files of old versions have forms of elements that this parser would take for damage, so their version is
// looked for first. A file of another format has none.
void require_new_head(std::string_view text) {
  const std::string_view head = text.substr(0, kHead);
  constexpr std::string_view kName = "FBXVersion:";
  const std::size_t at = head.find(kName);
  if (at == head.npos)
    throw InputError(
        "is no FBX file, whatever its name says: it neither begins as a binary one does nor names an "
        "FBXVersion; give it the extension of its own format");
  const std::size_t digits = head.find_first_not_of(" \t", at + kName.size());
  const std::size_t end = std::min(head.find_first_of(" \t\r\n;", digits), head.size());
  WrittenNumber version{};
  if (digits < end && read_number(head.substr(digits, end - digits), version) && version.is_integer)
    require_new(version.integer, false);
}

// Parses text files. Their form is `Name: value, value { children }`, with comments from ';' to the end of
// the line and arrays such as `*3 { a: 1,2,3 }`.
class TextParser {
 public:
  explicit TextParser(std::string_view text) : text_(text) {}

  Document parse() {
    Document document;
    read_elements(document.root.children, 0);
    for (const Element& element : document.root.children) {
      if (element.name != "FBXHeaderExtension") continue;
      if (const Element* version = element.child("FBXVersion")) document.version = version->integer(0);
    }
    if (document.version == 0)
      throw InputError("is no FBX file: it neither begins as a binary one does nor names an FBXVersion");
    return document;
  }

 private:
  [[noreturn]] void refuse(const char* what) const {
    std::size_t line = 1;
    for (std::size_t i = 0; i < at_; ++i)
      line += text_[i] == '\n' || (text_[i] == '\r' && text_.substr(i + 1, 1) != "\n");
    throw InputError("line " + std::to_string(line) + ": " + what +
                     "; the FBX file is damaged or cut short, export it again");
  }

  bool at_end() const { return at_ >= text_.size(); }
  char here() const { return at_end() ? '\0' : text_[at_]; }

  // Skips blanks and comments. Returns whether a line ended on the way.
  bool skip_blanks() {
    bool line_ended = false;
    while (!at_end()) {
      if (here() == ';')
        at_ = std::min(text_.find_first_of(kLineEnds, at_), text_.size());
      else if (kBlanks.find(here()) == kBlanks.npos)
        break;
      else
        line_ended = kLineEnds.find(text_[at_++]) != kLineEnds.npos || line_ended;
    }
    return line_ended;
  }

  void read_elements(std::vector<Element>& elements, int depth) {
    if (depth > kDeepest) throw InputError("its FBX elements are nested too deeply; export it again");
    for (;;) {
      skip_blanks();
      if (at_end()) {
        if (depth > 0) refuse("a brace is not closed");
        return;
      }
      if (here() == '}') {
        if (depth == 0) refuse("a brace closes nothing");
        ++at_;
        return;
      }
      const std::size_t colon = text_.find_first_of(":\r\n{}\"", at_);
      if (colon == text_.npos || text_[colon] != ':') refuse("an element's name has no colon");
      Element& element = elements.emplace_back();
      element.name = text_.substr(at_, colon - at_);
      at_ = colon + 1;
      read_values(element, depth);
    }
  }

  // Reads the values of an element. Values go on after a comma, whether the comma ends a line or begins one.
  void read_values(Element& element, int depth) {
    bool comma = false;
    for (;;) {
      const bool line_ended = skip_blanks();
      if (at_end() || here() == '}') return;
      if (here() == ',') {
        comma = true;
        ++at_;
        continue;
      }
      if (here() == '{') {
        ++at_;
        read_elements(element.children, depth + 1);
        return;
      }
      if (line_ended && !comma) return;
      comma = false;
      if (here() == '*') {
        read_array(element);
        return;
      }
      element.values.push_back(here() == '"' ? read_quoted() : read_word());
    }
  }

  Value read_quoted() {
    const std::size_t end = text_.find('"', at_ + 1);
    if (end == text_.npos) refuse("a quotation mark is not closed");
    Value value{Value::Kind::text, 0, 0, text_.substr(at_ + 1, end - at_ - 1)};
    at_ = end + 1;
    return value;
  }

  Value read_word() {
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n,{};", at_), text_.size());
    const std::string_view word = text_.substr(at_, end - at_);
    at_ = end;
    WrittenNumber number{};
    if (!read_number(word, number)) return {Value::Kind::text, 0, 0, word};
    return {number.is_integer ? Value::Kind::integer : Value::Kind::real, number.integer, number.real};
  }

  // Reads an array. The count after the star is not needed, because the numbers end at the brace.
  void read_array(Element& element) {
    const std::size_t open = text_.find_first_of("{}\r\n", at_);
    const std::size_t close = text_.find('}', at_);
    if (open == text_.npos || close == text_.npos || text_[open] != '{') refuse("an array has no braces");
    std::string_view body = text_.substr(open + 1, close - open - 1);
    const std::size_t colon = body.find(':');
    body.remove_prefix(colon == body.npos ? body.size() : colon + 1);
    Value value;
    value.kind = Value::Kind::array;
    value.array = {'t', false, 0, body};
    element.values.push_back(value);
    at_ = close + 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Document parse_text(std::string_view bytes) {
  require_new_head(bytes);
  return TextParser(bytes).parse();
}

}  // namespace cscd::scenes::fbx
