#include "scenes/import/collada/document.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "scenes/base/number_word.h"

namespace cscd::scenes::collada {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view after_hash(std::string_view url) {
  return url.starts_with('#') ? url.substr(1) : url;
}

// Comments and CDATA cut a text into pieces, of which assimp reads the first.
void join_text(pugi::xml_node element) {
  std::string text;
  std::size_t pieces = 0;
  for (const pugi::xml_node child : element.children()) {
    if (child.type() == pugi::node_element) return;
    if (child.type() != pugi::node_pcdata && child.type() != pugi::node_cdata) continue;
    text += child.value();
    ++pieces;
  }
  if (pieces < 2) return;
  element.remove_children();
  element.append_child(pugi::node_pcdata).set_value(text.c_str());
}

// Tells whether an element of this name is a list that others refer to.
bool holds_numbers(std::string_view name) {
  return name == "source" || name.ends_with("_array");
}

[[noreturn]] void refuse_word(pugi::xml_node element, std::size_t index, std::string_view word,
                              const std::string& what) {
  throw InputError(told(element) + ": entry " + std::to_string(index) + " (counted from 0), '" +
                   std::string(word.substr(0, 40)) + "', " + what + "; repair it or export the file again");
}

// assimp adds up the digits before the point in 64 bits.
bool has_too_many_digits(std::string_view word) {
  constexpr std::size_t kMost = 18;
  const std::size_t from = word.find_first_of("0123456789");
  return from != word.npos &&
         std::min(word.find_first_not_of("0123456789", from), word.size()) - from > kMost;
}

}  // namespace

std::string told(pugi::xml_node element) {
  const std::string name = "<" + std::string(element.name()) + ">";
  if (const pugi::xml_attribute id = element.attribute("id")) return name + " '" + id.value() + "'";
  for (pugi::xml_node above = element.parent(); above; above = above.parent())
    if (const pugi::xml_attribute id = above.attribute("id"))
      return name + " of <" + above.name() + "> '" + id.value() + "'";
  return name;
}

std::vector<std::string_view> words_of(pugi::xml_node element) {
  std::string_view text = element.child_value();
  std::vector<std::string_view> words;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
    if (text.empty()) return words;
    const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
    words.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
}

std::vector<double> numbers_of(pugi::xml_node element) {
  std::vector<double> numbers;
  for (const std::string_view word : words_of(element)) {
    const std::optional<double> number = number_of(word);
    if (!number) refuse_word(element, numbers.size(), word, "is no number");
    if (!std::isfinite(*number)) refuse_word(element, numbers.size(), word, "is not finite");
    if (has_too_many_digits(word)) refuse_word(element, numbers.size(), word, "has too many digits");
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<long> indices_of(pugi::xml_node element, long least) {
  std::vector<long> indices;
  for (const std::string_view word : words_of(element)) {
    long index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (error != std::errc{} || end != word.data() + word.size() || index < least)
      refuse_word(element, indices.size(), word, "is no index");
    indices.push_back(index);
  }
  return indices;
}

std::size_t count_in(pugi::xml_node element, const char* attribute, std::optional<std::size_t> otherwise) {
  const std::string_view word = element.attribute(attribute).value();
  if (word.empty() && otherwise) return *otherwise;
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (error != std::errc{} || end != word.data() + word.size())
    throw InputError(told(element) + ": its " + attribute + " is '" + std::string(word.substr(0, 40)) +
                     "', which is no count; repair it");
  return count;
}

Document::Document(const std::string& bytes, pugi::xml_document& document) {
  const pugi::xml_parse_result result = document.load_buffer(bytes.data(), bytes.size());
  if (!result)
    throw InputError("is no XML at byte " + std::to_string(result.offset) + " (" + result.description() +
                     "); the Collada file is damaged or cut short, export it again");
  root_ = document.child("COLLADA");
  if (!root_) throw InputError("has no element <COLLADA>; give it the extension of its own format");
  walk(root_, [this](pugi::xml_node element) {
    join_text(element);
    if (const pugi::xml_attribute id = element.attribute("id")) {
      // Elements of different kinds may share an id in practice. Of one kind, assimp takes the last.
      const auto [known, added] = by_id_.try_emplace(id.value(), element);
      if (!added && std::string_view(known->second.name()) == element.name() && holds_numbers(element.name()))
        throw InputError(told(element) + ": there are two with this id; rename one of them");
    }
    for (const char* attribute : {"id", "name", "sid"}) taken_.insert(element.attribute(attribute).value());
  });
}

pugi::xml_node Document::scene() const {
  const pugi::xml_node named =
      target_of(root_.child("scene").child("instance_visual_scene").attribute("url").value());
  return named ? named : root_.child("library_visual_scenes").child("visual_scene");
}

pugi::xml_node Document::target_of(std::string_view url) const {
  const auto found = by_id_.find(std::string(after_hash(url)));
  return found == by_id_.end() ? pugi::xml_node() : found->second;
}

pugi::xml_node Document::source_of(pugi::xml_node owner, std::string_view meaning) const {
  for (const pugi::xml_node input : owner.children("input"))
    if (input.attribute("semantic").value() == meaning) return target_of(input.attribute("source").value());
  return {};
}

std::optional<Source> Document::numbers_of_source(pugi::xml_node owner, std::string_view meaning) const {
  Source source;
  source.element = source_of(owner, meaning);
  source.accessor = source.element.child("technique_common").child("accessor");
  if (!source.accessor) return std::nullopt;
  source.array = target_of(source.accessor.attribute("source").value());
  if (source.array.name() != std::string_view("float_array"))
    throw InputError(told(source.element) +
                     ": has no <float_array>, and only such numbers are read; export it again");
  source.numbers = numbers_of(source.array);
  if (const std::size_t said = count_in(source.array, "count", std::nullopt); said != source.numbers.size())
    throw InputError(told(source.array) + ": says that it has " + std::to_string(said) +
                     " numbers, and has " + std::to_string(source.numbers.size()) + "; export it again");
  source.count = count_in(source.accessor, "count", std::nullopt);
  source.offset = count_in(source.accessor, "offset", 0);
  source.stride = count_in(source.accessor, "stride", 1);
  const std::size_t size = source.numbers.size();
  const bool fits = source.count == 0 || (source.stride > 0 && source.offset <= size &&
                                          source.count <= (size - source.offset) / source.stride);
  if (!fits)
    throw InputError(told(source.element) +
                     ": its accessor names numbers behind the last one; export it again");
  return source;
}

}  // namespace cscd::scenes::collada
