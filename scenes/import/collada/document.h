#pragma once

#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

// A Collada file's tree of elements, and what its elements refer to. assimp reads the surfaces and the
// motion; this project checks before that what assimp would take for something else without a word.
namespace cscd::scenes::collada {

// Where an element stands, as "<matrix> of <node> 'low'", for errors.
std::string told(pugi::xml_node element);

// Returns the words of an element's text. They point into the tree.
std::vector<std::string_view> words_of(pugi::xml_node element);
// Returns the numbers of an element's text. Throws InputError for a word that is no finite number, or that
// has more digits than assimp reads.
std::vector<double> numbers_of(pugi::xml_node element);
// Returns the whole numbers of an element's text, none of which may be less than `least`. Throws InputError.
std::vector<long> indices_of(pugi::xml_node element, long least);
// Returns an attribute that is a whole number, or `otherwise` where it is missing. Throws InputError.
std::size_t count_in(pugi::xml_node element, const char* attribute, std::optional<std::size_t> otherwise);

// Calls `visit` for every element, without recursion: a file may nest deeper than the stack allows.
template <class Visit>
void walk(pugi::xml_node root, const Visit& visit) {
  struct Walker final : pugi::xml_tree_walker {
    const Visit& visit;
    explicit Walker(const Visit& v) : visit(v) {}
    bool for_each(pugi::xml_node& node) override {
      if (node.type() == pugi::node_element) visit(node);
      return true;
    }
  } walker(visit);
  root.traverse(walker);
}

// The numbers of a source as an accessor lays them out.
struct Source {
  pugi::xml_node element, array, accessor;
  std::vector<double> numbers;
  std::size_t count = 0, offset = 0, stride = 1;  // of the accessor
};

class Document {
 public:
  // Puts the text of each element into one piece, as assimp needs it. Throws InputError for text that is no
  // XML and for files whose root is no Collada element. The document must outlive this.
  Document(const std::string& bytes, pugi::xml_document& document);

  pugi::xml_node root() const { return root_; }
  // The scene that is shown: the one that the file names, or else the first one. May be empty.
  pugi::xml_node scene() const;
  pugi::xml_node target_of(std::string_view url) const;
  // Whether an element of the file has this id, name or scoped id.
  bool is_taken(const std::string& name) const { return taken_.contains(name); }
  // The source named by the input of `owner` that has this meaning.
  pugi::xml_node source_of(pugi::xml_node owner, std::string_view meaning) const;
  // The same, with its numbers. Throws InputError where they are no numbers, are not as many as the file
  // says, or do not fill the accessor. Empty where `owner` has no such input.
  std::optional<Source> numbers_of_source(pugi::xml_node owner, std::string_view meaning) const;

 private:
  pugi::xml_node root_;
  std::map<std::string, pugi::xml_node> by_id_;
  std::set<std::string> taken_;
};

}  // namespace cscd::scenes::collada
