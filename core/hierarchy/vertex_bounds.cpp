#include <algorithm>

#include "core/hierarchy/bounds.h"

// Projections of blocks of vertices with the block index innermost, so that plain loops become vector code.
namespace cscd {
namespace {

constexpr std::size_t kBlock = 32;
using Row = double[kBlock];

// at_least[v] = min(at_least[v], largest float <= x[v]).
void lower(const Row& x, float* at_least) {
  for (std::size_t v = 0; v < kBlock; ++v) {
    const float bound = float_below(x[v]);
    at_least[v] = at_least[v] < bound ? at_least[v] : bound;  // of equal zeros the later, as in united
  }
}
// The same for the exact sum x + sign y.
void lower_sum(const Row& x, const Row& y, float* at_least) {
  for (std::size_t v = 0; v < kBlock; ++v) {
    const float bound = float_below_sum(x[v], y[v]);
    at_least[v] = at_least[v] < bound ? at_least[v] : bound;  // of equal zeros the later, as in united
  }
}

void lower_by_end(std::span<const Vec3> points, float (&rows)[16][kBlock]) {
  Row x, y, z, nx, ny, nz;
  for (std::size_t v = 0; v < kBlock; ++v) {
    const Vec3& p = points[std::min(v, points.size() - 1)];  // a short last block repeats its last vertex
    x[v] = p.x(), y[v] = p.y(), z[v] = p.z();
  }
  for (std::size_t v = 0; v < kBlock; ++v) nx[v] = -x[v], ny[v] = -y[v], nz[v] = -z[v];
  lower(x, rows[0]), lower(y, rows[1]), lower(z, rows[2]);
  lower_sum(x, y, rows[3]), lower_sum(x, z, rows[4]), lower_sum(y, z, rows[5]);
  lower_sum(x, ny, rows[6]), lower_sum(x, nz, rows[7]);
  lower(nx, rows[8]), lower(ny, rows[9]), lower(nz, rows[10]);
  lower_sum(nx, ny, rows[11]), lower_sum(nx, nz, rows[12]), lower_sum(ny, nz, rows[13]);
  lower_sum(nx, y, rows[14]), lower_sum(nx, z, rows[15]);
}

}  // namespace

void swept_vertex_bounds(const Motion& motion, std::span<Kdop16> out) {
  for (std::size_t first = 0; first < out.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, out.size() - first);
    alignas(64) float rows[16][kBlock];
    std::fill(&rows[0][0], &rows[0][0] + 16 * kBlock, std::numeric_limits<float>::infinity());
    lower_by_end(motion.start().subspan(first, count), rows);
    lower_by_end(motion.end().subspan(first, count), rows);
    for (std::size_t v = 0; v < count; ++v)
      for (std::size_t k = 0; k < 16; ++k) out[first + v].at_least[k] = rows[k][v];
  }
}

}  // namespace cscd
