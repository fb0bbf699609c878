#include "core/detect/start/pose_crossings.h"

#include <algorithm>
#include <cstring>

#include "core/elementary/exact/triangles_meet.h"

namespace cscd {

bool PoseCrossings::knows(std::span<const Vec3> positions) const {
  return positions.size() == positions_.size() && !positions.empty() &&
         std::memcmp(positions.data(), positions_.data(), positions.size_bytes()) == 0;
}

const Crossings& PoseCrossings::find(std::span<const Vec3> positions) {
  crossings_ = test_.find_all(positions, most_);
  positions_.assign(positions.begin(), positions.end());
  return crossings_;
}

void PoseCrossings::know(std::span<const Vec3> positions, const Crossings& crossings) {
  crossings_ = crossings;
  positions_.assign(positions.begin(), positions.end());
}

const Crossings& PoseCrossings::follow(std::span<const Vec3> positions, const ContactSet& touched) {
  if (positions_.empty() || !crossings_.all_kept()) return find(positions);
  positions_.assign(positions.begin(), positions.end());
  if (touched.contacts.empty()) return crossings_;

  const TriangleMesh& mesh = test_.mesh();
  std::vector<CrossingPair> changed;
  for (const Contact& contact : touched.contacts)
    for (const CrossingPair& pair : carriers(mesh, contact.pair)) changed.push_back(pair);
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  std::erase_if(crossings_.pairs, [&](const CrossingPair& pair) {
    return std::binary_search(changed.begin(), changed.end(), pair);
  });
  for (const CrossingPair& pair : changed)
    if (triangles_meet(mesh, positions, pair.first, pair.second)) crossings_.pairs.push_back(pair);
  std::sort(crossings_.pairs.begin(), crossings_.pairs.end());
  crossings_.total = crossings_.pairs.size();
  return crossings_;
}

}  // namespace cscd
