#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "bench/inputs/input.h"

namespace cscd::bench {

// Returns for each bone, [bones], those that are at most so many joints from it, itself among them.
std::vector<std::set<std::int32_t>> bones_within(std::span<const BoneId> parent, int joints);

// Has the answers about an input ignore what is asked (Input::ignored). A triangle belongs to the bone that
// moves most of its corners, to its part and to its mesh. Two triangles ignore each other if a request names
// a place of the one and a place of the other. A contact is ignored if every pair of triangles that has both
// its features is. Throws InputError for a name that the input does not have, and for neighbours where there
// are no bones.
void ignore(Input& input, const IgnoreRequest& request);

}  // namespace cscd::bench
