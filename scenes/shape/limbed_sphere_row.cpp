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
    text_row("name", "what the limb is called"),
    text_row("parent", "bone of the body on which the limb hangs; without it the body's last").optional(),
    text_row("bones", "names of the limb's bones, with blanks between; without it NAME_1 and so on")
        .optional(),
    table_row("joints", "length", 3, "x, y, z of each joint, from inside the body to the tip"),
    table_row(
        "sections", "share, length", 5,
        "rows of share of the limb's length, radius_u, radius_v, shift_u, shift_v; a share that does not "
        "rise makes an edge, square or overhanging"),
    number_row("tip", "length", "length over which the limb's end is rounded", {0, 1e12}).or_else({0}),
    text_row("face", "face of the cube on which the limb grows: -x, +x, -y, +y, -z or +z"),
    integer_row("cell_u", "", "lowest cell of the limb's patch along the face's first axis", {0, 1e6}),
    integer_row("cell_v", "", "lowest cell of the limb's patch along the face's second axis", {0, 1e6}),
    integer_row("size", "", "cells along each side of the limb's patch", {1, 1e6}),
    integer_row("rings", "", "rings of quads along the limb", {2, 1e7}),
    number_row("flare", "", "how much wider than the limb its outline on the body is", {1e-3, 1e3})
        .or_else({Limb{}.flare}),
    number_row("collar", "length", "length over which that outline becomes the limb's section", {1e-9, 1e12}),
    number_row("root_blend", "length", "length over which body and limb share the weights", {1e-9, 1e12}),
    number_row("blend", "", "the same at the limb's joints, as a share of the shorter bone", {1e-3, 1})
        .or_else({Limb{}.blend}),
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
      integer_row("cells", "", "cells along each edge of the cube that becomes the body", {1, 4000}),
      text_row("body_axis", "x, y or z: the body's sections lie across it"),
      table_row("body_sections", "length", 5,
                "rows of place along the axis, half_u, half_v, shift_u, shift_v"),
      integer_row("section_power", "", "2 for elliptic sections, and even; larger powers are more square",
                  {2, 64})
          .or_else({double(BodyForm::Spec{}.section_power)}),
      integer_row("end_power", "", "2 for elliptic ends, and even; larger powers are blunter", {2, 64})
          .or_else({double(BodyForm::Spec{}.end_power)}),
      text_row("body_bones", "names of the body's bones from the root, with blanks between"),
      table_row("body_joints", "length", 3, "x, y, z of each joint of the body, one more than bones"),
      number_row("body_blend", "length", "length over which the body's bones share the weights",
                 {1e-9, 1e12}),
      integer_row("relax", "", "sweeps that space the body's vertices evenly", {0, 1e5})
          .or_else({double(LimbedSphereParameters{}.relax)}),
      integer_row("smooth", "", "sweeps that round the creases where limbs begin", {0, 1e5})
          .or_else({double(LimbedSphereParameters{}.smooth)}),
      objects_row("limbs", "one object for each limb", kLimbRows),
      objects_row("details", "one object for each raised, dented or folded place", detail_rows()).optional(),
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
