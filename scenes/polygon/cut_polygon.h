#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

// How the readers of all formats cut polygons into triangles. Files of one format may come in many frames, so
// a reader cuts a polygon once and keeps the cut.
namespace cscd::scenes {

enum class PolygonCut {
  good,
  // The polygon is flat and overlaps itself, so that it has no inside. The triangles have its corners and its
  // border, and some of them face the other way.
  overlapping,
  // There is no good way to cut the polygon, and there are no triangles.
  none
};

// Adds the triangles of a polygon with three corners or more to `triangles`. Each triangle names its corners
// in the order in which they lie along the polygon. The polygon may be concave, may touch itself, may repeat
// corners or have them on straight lines, and need not be flat. A quadrilateral is cut along a diagonal that
// lies inside, and along the shorter one where both do. Positions that are not finite are for the caller to
// refuse; a polygon with one is cut in any way.
PolygonCut cut_polygon(std::span<const std::int32_t> corners, std::span<const Vec3> positions,
                       std::vector<std::array<std::int32_t, 3>>& triangles);

// Whether a polygon encloses any area, so that how it lies says how to cut it. A polygon that lies in a point
// or on a line, or whose halves turn against each other and are equally large, encloses none.
bool has_area(std::span<const std::int32_t> corners, std::span<const Vec3> positions);

// What a reader notes of overlapping polygons, behind their number.
inline constexpr char kOverlapping[] =
    "flat polygons overlap themselves, and what their inside is cannot be told; mend them in the file";

}  // namespace cscd::scenes
