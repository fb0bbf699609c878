#pragma once

#include <string>
#include <vector>

namespace cscd::scenes {

// What assimp's Collada importer would get wrong without a word: it takes the first of several nodes that a
// joint's name fits, and it joins all keys by straight lines. Throws InputError for names that fit several
// nodes, and for keys further apart than 1/60 s that are joined otherwise. Returns notes on nearer ones, of
// which straight lines lose nothing that matters. Text that is no XML is left to assimp to refuse.
std::vector<std::string> notes_on_collada(const std::string& xml);

}  // namespace cscd::scenes
