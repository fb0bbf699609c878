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
    {.name = "name", .kind = ParameterKind::text, .meaning = "what the limb is called"},
    {.name = "parent",
     .kind = ParameterKind::text,
     .meaning = "bone of the body on which the limb hangs; without it the body's last",
     .required = false},
    {.name = "bones",
     .kind = ParameterKind::text,
     .meaning = "names of the limb's bones, with blanks between; without it NAME_1 and so on",
     .required = false},
    {.name = "joints",
     .kind = ParameterKind::table,
     .unit = "length",
     .meaning = "x, y, z of each joint, from inside the body to the tip",
     .columns = 3},
    {.name = "sections",
     .kind = ParameterKind::table,
     .unit = "share, length",
     .meaning = "rows of share of the limb's length, radius_u, radius_v, shift_u, shift_v",
     .columns = 5},
    {.name = "tip",
     .kind = ParameterKind::number,
     .unit = "length",
     .meaning = "length over which the limb's end is rounded",
     .required = false,
     .least = 0,
     .most = 1e12,
     .otherwise = {0}},
    {.name = "face",
     .kind = ParameterKind::text,
     .meaning = "face of the cube on which the limb grows: -x, +x, -y, +y, -z or +z"},
    {.name = "cell_u",
     .kind = ParameterKind::integer,
     .meaning = "lowest cell of the limb's patch along the face's first axis",
     .least = 0,
     .most = 1e6},
    {.name = "cell_v",
     .kind = ParameterKind::integer,
     .meaning = "lowest cell of the limb's patch along the face's second axis",
     .least = 0,
     .most = 1e6},
    {.name = "size",
     .kind = ParameterKind::integer,
     .meaning = "cells along each side of the limb's patch",
     .least = 1,
     .most = 1e6},
    {.name = "rings",
     .kind = ParameterKind::integer,
     .meaning = "rings of quads along the limb",
     .least = 2,
     .most = 1e7},
    {.name = "flare",
     .kind = ParameterKind::number,
     .meaning = "how much wider than the limb its outline on the body is",
     .required = false,
     .least = 1e-3,
     .most = 1e3,
     .otherwise = {Limb{}.flare}},
    {.name = "collar",
     .kind = ParameterKind::number,
     .unit = "length",
     .meaning = "length over which that outline becomes the limb's section",
     .least = 1e-9,
     .most = 1e12},
    {.name = "root_blend",
     .kind = ParameterKind::number,
     .unit = "length",
     .meaning = "length over which body and limb share the weights",
     .least = 1e-9,
     .most = 1e12},
    {.name = "blend",
     .kind = ParameterKind::number,
     .meaning = "the same at the limb's joints, as a share of the shorter bone",
     .required = false,
     .least = 1e-3,
     .most = 1,
     .otherwise = {Limb{}.blend}},
};

Limb read_limb(const Parameters& p, const std::vector<std::string>& body_bones) {
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
  limb.form.tip = p.number("tip");
  const std::string& face = p.text("face");
  if (face.size() != 2 || (face[0] != '-' && face[0] != '+') || face[1] < 'x' || face[1] > 'z')
    throw InputError(p.where() + ": parameter face is " + face + "; it must be -x, +x, -y, +y, -z or +z");
  limb.face = {face[1] - 'x', face[0] == '+'};
  limb.cell_u = p.integer("cell_u");
  limb.cell_v = p.integer("cell_v");
  limb.size = p.integer("size");
  limb.rings = p.integer("rings");
  limb.flare = p.number("flare");
  limb.collar = p.number("collar");
  limb.root_blend = p.number("root_blend");
  limb.blend = p.number("blend");
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
      {.name = "cells",
       .kind = ParameterKind::integer,
       .meaning = "cells along each edge of the cube that becomes the body",
       .least = 1,
       .most = 4000},
      {.name = "body_axis",
       .kind = ParameterKind::text,
       .meaning = "x, y or z: the body's sections lie across it"},
      {.name = "body_sections",
       .kind = ParameterKind::table,
       .unit = "length",
       .meaning = "rows of place along the axis, half_u, half_v, shift_u, shift_v",
       .columns = 5},
      {.name = "section_power",
       .kind = ParameterKind::integer,
       .meaning = "2 for elliptic sections, and even; larger powers are more square",
       .required = false,
       .least = 2,
       .most = 64,
       .otherwise = {double(BodyForm::Spec{}.section_power)}},
      {.name = "end_power",
       .kind = ParameterKind::integer,
       .meaning = "2 for elliptic ends, and even; larger powers are blunter",
       .required = false,
       .least = 2,
       .most = 64,
       .otherwise = {double(BodyForm::Spec{}.end_power)}},
      {.name = "body_bones",
       .kind = ParameterKind::text,
       .meaning = "names of the body's bones from the root, with blanks between"},
      {.name = "body_joints",
       .kind = ParameterKind::table,
       .unit = "length",
       .meaning = "x, y, z of each joint of the body, one more than bones",
       .columns = 3},
      {.name = "body_blend",
       .kind = ParameterKind::number,
       .unit = "length",
       .meaning = "length over which the body's bones share the weights",
       .least = 1e-9,
       .most = 1e12},
      {.name = "relax",
       .kind = ParameterKind::integer,
       .meaning = "sweeps that space the body's vertices evenly",
       .required = false,
       .least = 0,
       .most = 1e5,
       .otherwise = {double(LimbedSphereParameters{}.relax)}},
      {.name = "smooth",
       .kind = ParameterKind::integer,
       .meaning = "sweeps that round the creases where limbs begin",
       .required = false,
       .least = 0,
       .most = 1e5,
       .otherwise = {double(LimbedSphereParameters{}.smooth)}},
      {.name = "limbs",
       .kind = ParameterKind::objects,
       .meaning = "one object for each limb",
       .items = kLimbRows},
      {.name = "details",
       .kind = ParameterKind::objects,
       .meaning = "one object for each raised, dented or folded place",
       .required = false,
       .items = detail_rows()},
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
            p.body.section_power = parameters.integer("section_power");
            p.body.end_power = parameters.integer("end_power");
            p.body_bones = words(parameters.text("body_bones"));
            p.body_joints = points(parameters.table("body_joints"));
            p.body_blend = parameters.number("body_blend");
            p.relax = parameters.integer("relax");
            p.smooth = parameters.integer("smooth");
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
