#pragma once

#include <string>
#include <vector>

namespace cscd::scenes {

// Checks the text of a Collada file for two things that assimp's Collada importer silently gets wrong.
// Where several nodes fit the name of a joint, assimp takes the first of them; and assimp joins all
// animation keys by straight lines. Throws InputError for joints whose name fits several nodes, and for
// keys further apart than 1/60 s that the file joins otherwise. Returns notes on such keys that are nearer,
// where straight lines lose nothing that matters. Text that is no XML yields no notes; assimp refuses it.
std::vector<std::string> notes_on_collada(const std::string& xml);

}  // namespace cscd::scenes
