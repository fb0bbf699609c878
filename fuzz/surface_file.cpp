// OBJ and PLY files.
#include "scenes/exchange/surface_file.h"

#include "core/base/error.h"
#include "fuzz/target.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const auto read : {scenes::read_obj, scenes::read_ply}) {
    scenes::SurfaceFile surface;
    try {
      surface = read(text);
    } catch (const InputError&) {
      continue;
    }
    for (const std::int32_t corner : surface.faces.corners)
      if (corner < 0 || static_cast<std::size_t>(corner) >= surface.positions.size())
        broken("an index is out of range");
    try {
      for (const auto& triangle : scenes::cut_faces(surface.faces, surface.positions).triangles)
        for (const std::int32_t corner : triangle)
          if (corner < 0 || static_cast<std::size_t>(corner) >= surface.positions.size())
            broken("a corner of a cut polygon is out of range");
    } catch (const InputError&) {
      continue;
    }
  }
}

}  // namespace cscd::fuzz
