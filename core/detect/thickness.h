#pragma once

#include <algorithm>
#include <span>

#include "core/base/ids.h"
#include "core/base/sum_above.h"
#include "core/detect/contact.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd {

// How near two features may come before they count as *close*. A feature pair is close if its distance is at
// most its thickness at some t in [0, 1]; with thickness 0, close means that the features touch. The
// thickness of a pair is `all`, and the largest of `of_vertex` among the vertices of either feature on top.
// Where a double does not hold this sum, the thickness is the sum rounded up, so that no pair within the
// exact sum is missed.
class Thickness {
 public:
  Thickness() = default;
  // Lengths in units of the positions, finite and at least 0. `of_vertex`, [vertices], is empty where all
  // vertices have 0, and must outlive the object.
  explicit Thickness(double all, std::span<const double> of_vertex = {}) : all_(all), of_vertex_(of_vertex) {
    largest_ = all;
    if (of_vertex.empty()) return;
    const auto [least, most] = std::ranges::minmax_element(of_vertex);
    largest_ = sum_above(all, std::max(0.0, *most), std::max(0.0, *most));
    is_uniform_ = *least == *most;
  }

  bool is_zero() const { return largest_ == 0; }
  // The largest thickness that any pair may have.
  double largest() const { return largest_; }
  // Whether all pairs have the same.
  bool is_uniform() const { return is_uniform_; }
  // The thickness of one pair.
  double of(const TriangleMesh& mesh, const FeaturePair& pair) const {
    if (of_vertex_.empty()) return all_;
    if (pair.kind == FeaturePair::Kind::vertex_face)
      return sum_above(all_, of_vertex_[static_cast<std::size_t>(pair.a)],
                       at(mesh.corners(TriangleId{pair.b})));
    return sum_above(all_, at(mesh.ends(EdgeId{pair.a})), at(mesh.ends(EdgeId{pair.b})));
  }

 private:
  template <class Vertices>
  double at(const Vertices& vertices) const {
    double most = 0;
    for (const VertexId v : vertices) most = std::max(most, of_vertex_[+v]);
    return most;
  }

  double all_ = 0, largest_ = 0;
  bool is_uniform_ = true;
  std::span<const double> of_vertex_;
};

}  // namespace cscd
