#include "bench/output/glossary.h"

#include <algorithm>
#include <cctype>

#include "bench/output/data.h"

namespace cscd::bench {
namespace {

constexpr const char* kFile = "glossary.json";

// Lower-case letters and digits, with one blank between words and one at either end, so that a form is found
// in a text as whole words alone.
std::string plain(std::string_view text) {
  std::string out = " ";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || byte >= 0x80)
      out += static_cast<char>(std::tolower(byte));
    else if (out.back() != ' ')
      out += ' ';
  }
  if (out.back() != ' ') out += ' ';
  return out;
}

template <class Fits>
bool any_form(const Word& word, const Fits& fits) {
  return fits(plain(word.name)) ||
         std::ranges::any_of(word.also, [&](const std::string& form) { return fits(plain(form)); });
}

}  // namespace

const std::vector<Word>& words() {
  static const std::vector<Word> all = [] {
    std::vector<Word> read;
    const nlohmann::ordered_json document = data_json(kFile);
    for (const nlohmann::ordered_json& word : document.at("words"))
      read.push_back({word.at("name"), word.at("also").get<std::vector<std::string>>(), word.at("means")});
    return read;
  }();
  return all;
}

const Word* word_called(std::string_view text) {
  const std::string asked = plain(text);
  const auto word = std::ranges::find_if(words(), [&](const Word& one) {
    return any_form(one, [&](const std::string& form) { return form == asked; });
  });
  return word == words().end() ? nullptr : &*word;
}

std::vector<std::string> words_in(std::string_view text) {
  const std::string read = plain(text);
  std::vector<std::string> found;
  for (const Word& word : words())
    if (any_form(word, [&](const std::string& form) { return read.find(form) != std::string::npos; }))
      found.push_back(word.name);
  return found;
}

std::optional<std::string> meaning_of_name(const std::string& name) {
  static const nlohmann::ordered_json names = data_json(kFile).at("names");
  if (const auto found = names.find(name); found != names.end()) return found->get<std::string>();
  return std::nullopt;
}

}  // namespace cscd::bench
