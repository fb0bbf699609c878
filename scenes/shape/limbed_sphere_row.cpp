#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/base/error.h"
#include "scenes/shape/limbed_sphere.h"

// Reads the description of a limbed sphere in a scene file.
namespace cscd::scenes {
namespace {

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) found.push_back(word);
  return found;
}

std::vector<Vec3> points(const Parameters::Table& table) {
  std::vector<Vec3> found;
  for (const std::vector<double>& row : table) found.push_back({row[0], row[1], row[2]});
  return found;
}

const ParameterRow kLimbRows[] = {
    {"name", ParameterKind::text, "what the limb is called"},
    {"parent", ParameterKind::text, "bone of the body on which it hangs; default its last", false},
    {"bones", ParameterKind::text, "names of its bones; default NAME_1 and so on", false},
    {"joints", ParameterKind::table, "x, y, z, from inside the body to the tip", true, -1e300, 1e300, 3},
    {"sections", ParameterKind::table, "share of its length, radius_u, radius_v, shift_u, shift_v", true,
     -1e300, 1e300, 5},
    {"tip", ParameterKind::number, "over which length its end is rounded", false, 0, 1e12},
    {"face", ParameterKind::text, "of the cube, on which it grows: -x, +x, -y, +y, -z or +z"},
    {"cell_u", ParameterKind::integer, "lowest cell of its patch, along the face's first axis", true, 0, 1e6},
    {"cell_v", ParameterKind::integer, "the same along the second", true, 0, 1e6},
    {"size", ParameterKind::integer, "cells along each side of its patch", true, 1, 1e6},
    {"rings", ParameterKind::integer, "rings of quads along it", true, 2, 1e7},
    {"flare", ParameterKind::number, "how much wider than the limb its outline on the body is", false, 1e-3,
     1e3},
    {"collar", ParameterKind::number, "over which length that outline becomes the limb's section", true, 1e-9,
     1e12},
    {"root_blend", ParameterKind::number, "over which length body and limb share the weights", true, 1e-9,
     1e12},
    {"blend", ParameterKind::number, "the same at its joints, as a share of the shorter bone", false, 1e-3,
     1},
};

Limb read_limb(const Parameters& p, const std::vector<std::string>& body_bones) {
  check(p, kLimbRows);
  Limb limb;
  limb.name = p.text("name");
  limb.parent = p.has("parent") ? p.text("parent") : body_bones.empty() ? "" : body_bones.back();
  limb.form.joints = points(p.table("joints"));
  if (p.has("bones"))
    limb.bones = words(p.text("bones"));
  else
    for (std::size_t i = 1; i < limb.form.joints.size(); ++i)
      limb.bones.push_back(limb.name + "_" + std::to_string(i));
  limb.form.sections = p.table("sections");
  limb.form.tip = p.number("tip", 0);
  const std::string& face = p.text("face");
  if (face.size() != 2 || (face[0] != '-' && face[0] != '+') || face[1] < 'x' || face[1] > 'z')
    throw InputError(p.where() + ": parameter face is " + face + "; it must be -x, +x, -y, +y, -z or +z");
  limb.face = {face[1] - 'x', face[0] == '+'};
  limb.cell_u = p.integer("cell_u");
  limb.cell_v = p.integer("cell_v");
  limb.size = p.integer("size");
  limb.rings = p.integer("rings");
  limb.flare = p.number("flare", limb.flare);
  limb.collar = p.number("collar");
  limb.root_blend = p.number("root_blend");
  limb.blend = p.number("blend", limb.blend);
  return limb;
}

// A limb at another resolution. Its patch keeps its middle on the face. If the size of the patch has to be
// rounded, the number of rings makes up for it, so that the limb keeps its share of the triangles.
Parameters scaled_limb(const Parameters& limb, double factor, int cells, double scaled_cells) {
  const int size = limb.integer("size");
  const double scaled_size = scaled_count(size, factor, 1);
  const auto lowest = [&](const char* cell) {
    const double middle = (limb.integer(cell) + size / 2.0) / cells;
    return std::clamp(std::round(middle * scaled_cells - scaled_size / 2), 0.0,
                      std::max(0.0, scaled_cells - scaled_size));
  };
  return limb.with("size", scaled_size)
      .with("cell_u", lowest("cell_u"))
      .with("cell_v", lowest("cell_v"))
      .with("rings", scaled_count(limb.integer("rings"), factor * factor * size / scaled_size, 2));
}

}  // namespace

ShapeRow limbed_sphere_row() {
  static const ParameterRow rows[] = {
      {"cells", ParameterKind::integer, "along each edge of the cube that becomes the body", true, 1, 4000},
      {"body_axis", ParameterKind::text, "x, y or z: the body's sections lie across it"},
      {"body_sections", ParameterKind::table, "along the axis, half_u, half_v, shift_u, shift_v", true,
       -1e300, 1e300, 5},
      {"section_power", ParameterKind::integer, "2 for elliptic sections, even; more the squarer", false, 2,
       64},
      {"end_power", ParameterKind::integer, "2 for elliptic ends, even; more the blunter", false, 2, 64},
      {"body_bones", ParameterKind::text, "names of the body's bones, from the root"},
      {"body_joints", ParameterKind::table, "x, y, z, one more than bones", true, -1e300, 1e300, 3},
      {"body_blend", ParameterKind::number, "over which length its bones share the weights", true, 1e-9,
       1e12},
      {"relax", ParameterKind::integer, "sweeps that space the body's vertices evenly", false, 0, 1e5},
      {"smooth", ParameterKind::integer, "sweeps that round the creases where limbs begin", false, 0, 1e5},
      {"limbs", ParameterKind::objects, "one object a limb"},
      {"details", ParameterKind::objects, "one object for each raised, dented or folded place", false},
  };
  return {"limbed_sphere",
          "body of a cube's grid, patches of which are extruded into limbs",
          rows,
          [](const Parameters& parameters) {
            LimbedSphereParameters p;
            p.cells = parameters.integer("cells");
            const std::string& axis = parameters.text("body_axis");
            if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z')
              throw InputError(parameters.where() + ": parameter body_axis is " + axis +
                               "; it must be x, y or z");
            p.body.axis = axis[0] - 'x';
            p.body.sections = parameters.table("body_sections");
            p.body.section_power = parameters.integer("section_power", p.body.section_power);
            p.body.end_power = parameters.integer("end_power", p.body.end_power);
            p.body_bones = words(parameters.text("body_bones"));
            p.body_joints = points(parameters.table("body_joints"));
            p.body_blend = parameters.number("body_blend");
            p.relax = parameters.integer("relax", p.relax);
            p.smooth = parameters.integer("smooth", p.smooth);
            for (const Parameters& limb : parameters.objects("limbs"))
              p.limbs.push_back(read_limb(limb, p.body_bones));
            if (parameters.has("details")) p.details = read_details(parameters.objects("details"));
            return limbed_sphere(p);
          },
          [](const Parameters& parameters, double factor) {
            const int cells = parameters.integer("cells");
            const double scaled_cells = scaled_count(cells, factor, 1);
            std::vector<Parameters> limbs;
            for (const Parameters& limb : parameters.objects("limbs"))
              limbs.push_back(scaled_limb(limb, factor, cells, scaled_cells));
            return parameters.with("cells", scaled_cells).with("limbs", std::move(limbs));
          },
          true};
}

}  // namespace cscd::scenes
