#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What the words mean that this program uses in its own sense. They are data, glossary.json, which help,
// `cscd list` and bench/README.md share: each is explained in two sentences.
namespace cscd::bench {

struct Word {
  std::string name;
  std::vector<std::string> also = {};  // further forms, such as a plural or words that are explained with it
  std::string means;
};

// The words, in the order of the file.
const std::vector<Word>& words();

// Returns the word that a text names in any of its forms; capitals, blanks, dashes and underscores make no
// difference. Null where there is none.
const Word* word_called(std::string_view text);

// The names of the words that occur in a text in any of their forms, in the order of the file.
std::vector<std::string> words_in(std::string_view text);

// What a strategy or an elementary test is; nothing for a name that is none of theirs.
std::optional<std::string> meaning_of_name(const std::string& name);

}  // namespace cscd::bench
