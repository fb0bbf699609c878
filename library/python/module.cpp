#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "cscd/cscd.h"

// The Python module `cscd`: the library with numpy arrays in and out. Row-major arrays of doubles are read
// where they are. Calls release the lock of the interpreter.
namespace {

namespace py = pybind11;
using cscd::SelfCollision;
using Contacts = std::vector<SelfCollision::Contact>;

// An array of one row a contact, of `width` numbers that get(contact, k) gives.
template <class Number, class Get>
py::array_t<Number> rows_of(const Contacts& contacts, std::size_t width, const Get& get) {
  py::array_t<Number> out({contacts.size(), width});
  auto rows = out.template mutable_unchecked<2>();
  for (std::size_t i = 0; i < contacts.size(); ++i)
    for (std::size_t k = 0; k < width; ++k)
      rows(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = get(contacts[i], k);
  return out;
}

template <class Number, class Get>
py::array_t<Number> column_of(const Contacts& contacts, const Get& get) {
  py::array_t<Number> out(static_cast<py::ssize_t>(contacts.size()));
  auto column = out.template mutable_unchecked<1>();
  for (std::size_t i = 0; i < contacts.size(); ++i) column(static_cast<py::ssize_t>(i)) = get(contacts[i]);
  return out;
}

template <std::size_t kWidth>
py::array_t<int> table_of(const std::vector<std::array<int, kWidth>>& rows) {
  py::array_t<int> out({rows.size(), kWidth});
  if (!rows.empty()) std::copy_n(rows.front().data(), rows.size() * kWidth, out.mutable_data());
  return out;
}

// Obstacles: faces and positions of each.
using Surfaces = std::vector<std::pair<Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>,
                                       Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>>;

constexpr auto kWithoutLock = py::call_guard<py::gil_scoped_release>();

}  // namespace

PYBIND11_MODULE(_cscd, module) {
  module.doc() = "Continuous self-collision detection of deforming triangle meshes.";

  py::class_<SelfCollision::Exclusions>(module, "Exclusions", R"(What does not count as a collision.

Two features may collide if some vertex of one may collide with some vertex of the other.)")
      .def(py::init([](std::vector<bool> obstacle, std::vector<int> group,
                       std::vector<std::pair<int, int>> ignoring, std::vector<std::pair<int, int>> vertices,
                       std::vector<std::pair<int, int>> faces, int rings, double rest_distance) {
             return SelfCollision::Exclusions{std::move(obstacle), std::move(group), std::move(ignoring),
                                              std::move(vertices), std::move(faces), rings,
                                              rest_distance};
           }),
           py::kw_only(), py::arg("obstacle") = std::vector<bool>(), py::arg("group") = std::vector<int>(),
           py::arg("groups_that_ignore_each_other") = std::vector<std::pair<int, int>>(),
           py::arg("vertex_pairs") = std::vector<std::pair<int, int>>(),
           py::arg("face_pairs") = std::vector<std::pair<int, int>>(), py::arg("rings") = 0,
           py::arg("rest_distance") = 0.0,
           R"(obstacle: [vertices] bool; vertices that never collide with each other.
group: [vertices] int from 0, and pairs of groups that do not collide with each other.
vertex_pairs, face_pairs: pairs of indices that do not collide.
rings: vertices that are joined by at most so many edges do not collide.
rest_distance: nor do vertices nearer than this in the reference positions.)");

  py::class_<SelfCollision::Contact>(module, "Contact", "Two features that touch.")
      .def_readonly("edges", &SelfCollision::Contact::edges,
                    "Whether two edges touch; otherwise a vertex and a face.")
      .def_readonly("vertices", &SelfCollision::Contact::vertices,
                    "The vertex and the corners of the face, or the ends of both edges.")
      .def_readonly("face", &SelfCollision::Contact::face, "The face, or -1.")
      .def_readonly("time", &SelfCollision::Contact::time, "The earliest time of the contact, in [0, 1].")
      .def_readonly("point", &SelfCollision::Contact::point, "Where the two touch at that time, [3].")
      .def_readonly("normal", &SelfCollision::Contact::normal,
                    "Unit vector from the second feature towards where the first came from, [3]; or zero.")
      .def_readonly("weights", &SelfCollision::Contact::weights,
                    "Barycentric weights in the face, or the shares of the way along both edges, [3].")
      .def_readonly("normal_velocity", &SelfCollision::Contact::normal_velocity,
                    "Of the first feature away from the second, in lengths a step.");

  py::class_<SelfCollision::Answer>(module, "Answer", "What is known of one step.")
      .def_readonly("contacts", &SelfCollision::Answer::contacts, "List of Contact, by time.")
      .def_property_readonly("free", &SelfCollision::Answer::free, "Whether nothing touches or crosses.")
      .def_property_readonly("time", &SelfCollision::Answer::time, "Of the earliest contact, or None.")
      .def_property_readonly("intersects_at_start", &SelfCollision::Answer::intersects_at_start)
      .def_property_readonly(
          "start_crossings", [](const SelfCollision::Answer& a) { return table_of(a.start_crossings); },
          "[pairs, 2] int: faces that cross at the start.")
      .def_property_readonly(
          "times",
          [](const SelfCollision::Answer& a) {
            return column_of<double>(a.contacts, [](const auto& c) { return c.time; });
          },
          "[contacts] float")
      .def_property_readonly(
          "edges",
          [](const SelfCollision::Answer& a) {
            return column_of<bool>(a.contacts, [](const auto& c) { return c.edges; });
          },
          "[contacts] bool")
      .def_property_readonly(
          "vertices",
          [](const SelfCollision::Answer& a) {
            return rows_of<int>(a.contacts, 4, [](const auto& c, std::size_t k) { return c.vertices[k]; });
          },
          "[contacts, 4] int")
      .def_property_readonly(
          "faces",
          [](const SelfCollision::Answer& a) {
            return column_of<int>(a.contacts, [](const auto& c) { return c.face; });
          },
          "[contacts] int; -1 where edges touch")
      .def_property_readonly(
          "points",
          [](const SelfCollision::Answer& a) {
            return rows_of<double>(a.contacts, 3, [](const auto& c, std::size_t k) {
              return c.point[static_cast<Eigen::Index>(k)];
            });
          },
          "[contacts, 3] float")
      .def_property_readonly(
          "normals",
          [](const SelfCollision::Answer& a) {
            return rows_of<double>(a.contacts, 3, [](const auto& c, std::size_t k) {
              return c.normal[static_cast<Eigen::Index>(k)];
            });
          },
          "[contacts, 3] float")
      .def("__repr__", [](const SelfCollision::Answer& a) {
        return "<cscd.Answer: " + std::to_string(a.contacts.size()) + " contacts, " +
               std::to_string(a.start_crossings.size()) + " crossings at the start>";
      });

  py::class_<SelfCollision>(module, "SelfCollision", R"(Continuous self-collision detection of one mesh.

faces: [faces, 3] int, corners counter-clockwise seen from outside.
reference: [vertices, 3] float, a pose without crossings, such as the pose at rest.
obstacles: list of (faces, positions) of surfaces that the mesh collides with, and that never collide with each
other; each rests until place_obstacle() or move_obstacle(). Their vertices and faces are numbered behind the
mesh's, in contacts and in `exclude`.
A step is two arrays of positions, [vertices, 3] float: every vertex moves in a straight line from the first to
the second. Answers are exact for the numbers as they are given. Wrong input raises ValueError.
One object is used by one thread at a time; different objects are independent.)")
      .def(py::init([](const SelfCollision::Faces& faces, const SelfCollision::Positions& reference,
                       int threads, bool check_positions, bool check_start,
                       const SelfCollision::Exclusions& exclude, const Surfaces& obstacles,
                       const std::string& preparation) {
             SelfCollision::Options options{threads, check_positions, check_start, exclude, {}, {}};
             const auto* const bytes = reinterpret_cast<const std::byte*>(preparation.data());
             options.preparation.assign(bytes, bytes + preparation.size());
             for (const auto& [corners, positions] : obstacles)
               options.obstacles.emplace_back(corners, positions);
             return std::make_unique<SelfCollision>(faces, reference, std::move(options));
           }),
           py::arg("faces"), py::arg("reference"), py::kw_only(), py::arg("threads") = 1,
           py::arg("check_positions") = true, py::arg("check_start") = true,
           py::arg("exclude") = SelfCollision::Exclusions(), py::arg("obstacles") = Surfaces(),
           py::arg("preparation") = py::bytes(), kWithoutLock)
      .def("place_obstacle", &SelfCollision::place_obstacle, py::arg("obstacle"), py::arg("positions"),
           kWithoutLock, "Places an obstacle, counted from 0, where it rests in the steps from then on.")
      .def("move_obstacle", &SelfCollision::move_obstacle, py::arg("obstacle"), py::arg("start"),
           py::arg("end"), kWithoutLock,
           "Moves an obstacle from start to end in every step, until it is placed or moved again.")
      .def("is_free", &SelfCollision::is_free, py::arg("start"), py::arg("end"), kWithoutLock,
           "Returns whether the step is free of contacts, and starts without crossings.")
      .def("first_contact",
           py::overload_cast<const SelfCollision::Positions&, const SelfCollision::Positions&>(
               &SelfCollision::first_contact),
           py::arg("start"), py::arg("end"), kWithoutLock,
           "Returns an Answer with contacts of the earliest time, at least one where anything touches.")
      .def("all_contacts",
           py::overload_cast<const SelfCollision::Positions&, const SelfCollision::Positions&>(
               &SelfCollision::all_contacts),
           py::arg("start"), py::arg("end"), kWithoutLock, "Returns an Answer with all contacts.")
      .def("largest_step", &SelfCollision::largest_step, py::arg("start"), py::arg("end"),
           py::arg("safety") = 0.9, kWithoutLock,
           "Returns a time t in [0, 1] such that nothing touches in [0, t]; 1 for a free step.")
      .def(
          "candidates",
          [](SelfCollision& self, const SelfCollision::Positions& start, const SelfCollision::Positions& end,
             double radius) {
            SelfCollision::Candidates found;
            {
              const py::gil_scoped_release without_lock;
              found = self.candidates(start, end, radius);
            }
            return py::make_tuple(table_of(found.vertex_face), table_of(found.edge_edge));
          },
          py::arg("start"), py::arg("end"), py::arg("radius"),
          "Returns all pairs that come within the radius: [n, 2] int of a vertex and a face, and [m, 4] int "
          "of "
          "the ends of two edges.")
      .def(
          "preparation",
          [](const SelfCollision& self) {
            const std::vector<std::byte> bytes = self.preparation();
            return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
          },
          "Returns what preparing the mesh has found out, as bytes for the argument `preparation` of another "
          "object of the same mesh, or of one that has changed in places since.")
      .def_property_readonly("vertex_count", &SelfCollision::vertex_count)
      .def_property_readonly("face_count", &SelfCollision::face_count)
      .def_property_readonly("closed", &SelfCollision::closed);

  module.def("instruction_set", &cscd::instruction_set,
             "Returns the instruction set that the engine uses: avx512, avx2 or baseline. CSCD_ISA in the "
             "environment chooses another.");
}
