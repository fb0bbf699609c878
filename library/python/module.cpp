#include <algorithm>
#include <pybind11/eigen.h>  // vectors of contacts
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <stdexcept>

#include "cscd/cscd.h"

// The module `cscd._cscd`: the library with numpy arrays in and out. The package around it (cscd/__init__.py)
// turns what callers give into arrays of the types below, which are read where they are, and has the
// documentation. Calls release the lock of the interpreter.

// pybind11 makes memory for an object when a method is called before __init__(), and leaves it as it is. An
// object of such a class is read through this caster, which refuses that.
namespace pybind11::detail {

template <class Type>
struct MadeObjectCaster : type_caster_base<Type> {
  bool load(handle source, bool convert) {
    if (isinstance<Type>(source) && !reinterpret_cast<instance*>(source.ptr())
                                         ->get_value_and_holder(get_type_info(typeid(Type)))
                                         .holder_constructed())
      throw std::runtime_error("this object of cscd has not been made; call super().__init__() first");
    return type_caster_base<Type>::load(source, convert);
  }
};
template <>
struct type_caster<cscd::SelfCollision> : MadeObjectCaster<cscd::SelfCollision> {};
template <>
struct type_caster<cscd::SelfCollision::Exclusions> : MadeObjectCaster<cscd::SelfCollision::Exclusions> {};

}  // namespace pybind11::detail

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

py::array_t<double> table_of(const std::vector<Eigen::Vector3d>& rows) {
  py::array_t<double> out({rows.size(), std::size_t{3}});
  if (!rows.empty()) std::copy_n(rows.front().data(), rows.size() * 3, out.mutable_data());
  return out;
}

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& numbers) {
  return py::array_t<Number>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

// A table of numbers, row by row.
template <class Number>
using Table = py::array_t<Number, py::array::c_style>;
using Reals = Table<double>;
using Surfaces = std::vector<std::pair<Table<int>, Reals>>;  // faces and positions

template <class Number>
cscd::MatrixView<Number> view(const Table<Number>& table) {
  using Rows = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(table.data(), table.shape(0), table.shape(1));
}

std::size_t index_of(int obstacle) {
  if (obstacle < 0)
    throw std::invalid_argument("obstacle " + std::to_string(obstacle) + ": obstacles are counted from 0");
  return static_cast<std::size_t>(obstacle);
}

constexpr auto kWithoutLock = py::call_guard<py::gil_scoped_release>();

// Protocols 0 and 1 of pickle ask the common base of compiled classes for a value, which it has not. Objects
// of such a class are pickled by protocol 2 instead.
template <class Type>
void use_newer_protocols(py::class_<Type>& type) {
  type.def("__reduce_ex__", [](const py::object& self, int protocol) {
    return py::module_::import("builtins").attr("object").attr("__reduce_ex__")(self, std::max(protocol, 2));
  });
}

// Has objects of a class pickled and copied by the listed members, in order.
template <class Type, class... Members>
void pickle_by(py::class_<Type>& type, Members Type::*... members) {
  type.def(py::pickle([=](const Type& value) { return py::make_tuple(value.*members...); },
                      [=](const py::tuple& state) {
                        if (state.size() != sizeof...(members))
                          throw std::invalid_argument(
                              "this was pickled by another version of cscd; make it anew");
                        Type value{};
                        std::size_t i = 0;
                        ((value.*members = state[i++].template cast<Members>()), ...);
                        return value;
                      }));
  use_newer_protocols(type);
}

}  // namespace

PYBIND11_MODULE(_cscd, module) {
  module.doc() = "Continuous self-collision detection of deforming triangle meshes.";
  module.attr("__version__") = CSCD_VERSION;

  py::class_<SelfCollision::Exclusions>(module, "Exclusions")
      .def(
          py::init([](std::vector<bool> rigid, std::vector<int> group,
                      std::vector<std::pair<int, int>> ignoring, std::vector<std::pair<int, int>> vertices,
                      std::vector<std::pair<int, int>> faces, int rings, double rest_distance, bool ongoing) {
            return SelfCollision::Exclusions{std::move(rigid),    std::move(group), std::move(ignoring),
                                             std::move(vertices), std::move(faces), rings,
                                             rest_distance,       ongoing};
          }));

  using Contact = SelfCollision::Contact;
  py::class_<Contact> contact(module, "Contact", "Two features that touch.");
  contact.def_readonly("edges", &Contact::edges, "Whether two edges touch; otherwise a vertex and a face.")
      .def_readonly("vertices", &Contact::vertices,
                    "The vertex and the corners of the face, or the ends of both edges.")
      .def_readonly("face", &Contact::face, "The face, or -1.")
      .def_readonly("time", &Contact::time, "The earliest time of the contact, in [0, 1].")
      .def_readonly("point", &Contact::point, "Where the two touch at that time, on the first feature, [3].")
      .def_readonly("normal", &Contact::normal,
                    "Unit vector from the second feature towards where the first came from, [3]; or zero.")
      .def_readonly("weights", &Contact::weights,
                    "Barycentric weights in the face, or the shares of the way along both edges, [3].")
      .def_readonly("normal_velocity", &Contact::normal_velocity,
                    "Of the first feature away from the second, in lengths a step.")
      .def("__repr__", [](const Contact& c) {
        const auto& [p, q, r, s] = c.vertices;
        return py::str(c.edges ? "<cscd.Contact: edges {} {} and {} {}, at t = {}>"
                               : "<cscd.Contact: vertex {} and face {} {} {}, at t = {}>")
            .format(p, q, r, s, c.time);
      });
  pickle_by(contact, &Contact::edges, &Contact::vertices, &Contact::face, &Contact::time, &Contact::point,
            &Contact::normal, &Contact::weights, &Contact::normal_velocity);

  using Answer = SelfCollision::Answer;
  py::class_<Answer> answer(module, "Answer", "What is known of one step.");
  answer.def_readonly("contacts", &Answer::contacts, "List of Contact, by time.")
      .def_property_readonly("free", &Answer::free, "Whether nothing touches or crosses.")
      .def_property_readonly("close_at_start", &Answer::close_at_start,
                             "How many pairs touch, or with a thickness are close, at the start already.")
      .def_property_readonly("time", &Answer::time, "Of the earliest contact, or None.")
      .def_property_readonly("intersects_at_start", &Answer::intersects_at_start)
      .def_property_readonly(
          "start_crossings", [](const Answer& a) { return table_of(a.start_crossings); },
          "[pairs, 2] int: faces that cross at the start.")
      .def_property_readonly(
          "times",
          [](const Answer& a) { return column_of<double>(a.contacts, [](const auto& c) { return c.time; }); },
          "[contacts] float")
      .def_property_readonly(
          "edges",
          [](const Answer& a) { return column_of<bool>(a.contacts, [](const auto& c) { return c.edges; }); },
          "[contacts] bool")
      .def_property_readonly(
          "vertices",
          [](const Answer& a) {
            return rows_of<int>(a.contacts, 4, [](const auto& c, std::size_t k) { return c.vertices[k]; });
          },
          "[contacts, 4] int")
      .def_property_readonly(
          "faces",
          [](const Answer& a) { return column_of<int>(a.contacts, [](const auto& c) { return c.face; }); },
          "[contacts] int; -1 where edges touch")
      .def_property_readonly(
          "points",
          [](const Answer& a) {
            return rows_of<double>(a.contacts, 3, [](const auto& c, std::size_t k) {
              return c.point[static_cast<Eigen::Index>(k)];
            });
          },
          "[contacts, 3] float")
      .def_property_readonly(
          "normals",
          [](const Answer& a) {
            return rows_of<double>(a.contacts, 3, [](const auto& c, std::size_t k) {
              return c.normal[static_cast<Eigen::Index>(k)];
            });
          },
          "[contacts, 3] float")
      .def("__repr__", [](const Answer& a) {
        return "<cscd.Answer: " + std::to_string(a.contacts.size()) + " contacts, " +
               std::to_string(a.start_crossings.size()) + " crossings at the start>";
      });
  pickle_by(answer, &Answer::start_crossings, &Answer::contacts);

  using Crossings = SelfCollision::Crossings;
  using Curve = Crossings::Curve;
  py::class_<Curve> curve(module, "Curve", "A curve in which two sheets of the surface cross.");
  curve.def_readonly("closed", &Curve::closed)
      .def_property_readonly(
          "faces", [](const Curve& c) { return table_of(c.faces); },
          "[segments, 2] int: the face of one sheet and of the other.")
      .def_property_readonly(
          "points", [](const Curve& c) { return table_of(c.points); },
          "[segments, 3] float, or one more row where the curve is not closed: the ends of the segments.");
  pickle_by(curve, &Curve::faces, &Curve::points, &Curve::closed);
  using Region = Crossings::Region;
  py::class_<Region> region(module, "Region", "What curves cut off one sheet.");
  region
      .def_property_readonly(
          "bounds", [](const Region& r) { return table_of(r.bounds); },
          "[bounds, 2] int: a curve of the overlap that bounds it, and the column of that curve's faces on "
          "whose sheet it lies.")
      .def_property_readonly(
          "vertices", [](const Region& r) { return array_of(r.vertices); },
          "[vertices] int, from the curves inwards.")
      .def_property_readonly(
          "distances", [](const Region& r) { return array_of(r.distance); },
          "[vertices] float: the lengths of the ways.")
      .def_property_readonly(
          "ways", [](const Region& r) { return table_of(r.way); },
          "[vertices, 3] float: from each to the nearest point of the skin that was gone through. A "
          "repair moves vertices along their ways.")
      .def_readonly("area", &Region::area)
      .def_readonly("behind", &Region::behind,
                    "Whether it lies behind the faces of the other sheet, inside a closed surface. Otherwise "
                    "the surface is turned inside out there, or it is the smaller side of an open one.")
      .def_readonly("other_is_open", &Region::other_is_open,
                    "Whether what is cut off the other sheet is not bounded.")
      .def_readonly("depth", &Region::depth, "The largest distance of a vertex.")
      .def_readonly("depth_bound", &Region::depth_bound, "What no point of the region exceeds.")
      .def_readonly("deepest", &Region::deepest, "The vertex with the largest distance.")
      .def_readonly("out", &Region::out, "The way from there to the nearest point of the other sheet, [3].");
  pickle_by(region, &Region::bounds, &Region::vertices, &Region::way, &Region::distance, &Region::area,
            &Region::behind, &Region::other_is_open, &Region::depth, &Region::depth_bound, &Region::deepest,
            &Region::out);
  using Overlap = Crossings::Overlap;
  py::class_<Overlap> overlap(module, "Overlap", "Curves and regions that hang together.");
  overlap.def_readonly("curves", &Overlap::curves, "List of Curve.")
      .def_readonly("regions", &Overlap::regions, "List of Region, deepest first.")
      .def_readonly("depth", &Overlap::depth)
      .def_readonly("length", &Overlap::length, "Of the curves together.")
      .def_property_readonly(
          "vertices", [](const Overlap& o) { return array_of(o.vertices); },
          "[vertices] int, the corners of the edges and faces that pierce each other along the curves.")
      .def_property_readonly(
          "gradient", [](const Overlap& o) { return table_of(o.gradient); },
          "[vertices, 3] float: of the length. Against it, vertices move to shorten the curves.")
      .def_readonly("depth_bound", &Overlap::depth_bound);
  pickle_by(overlap, &Overlap::curves, &Overlap::regions, &Overlap::depth, &Overlap::depth_bound,
            &Overlap::length, &Overlap::vertices, &Overlap::gradient);
  py::class_<Crossings> crossings(module, "Crossings", "How a pose crosses itself.");
  crossings.def_readonly("overlaps", &Crossings::overlaps, "List of Overlap, deepest first.")
      .def_readonly("touching", &Crossings::touching,
                    "Pairs of faces that meet without passing through each other.");
  pickle_by(crossings, &Crossings::overlaps, &Crossings::touching);

  using PathsAnswer = SelfCollision::PathsAnswer;
  py::class_<PathsAnswer> paths_answer(module, "PathsAnswer", "What is known of paths over a span of time.");
  use_newer_protocols(paths_answer);
  paths_answer
      .def(py::pickle(
          [](const PathsAnswer& a) {
            return py::make_tuple(static_cast<int>(a.verdict), a.from, a.to, a.within, a.faces);
          },
          [](const py::tuple& state) {
            return PathsAnswer{static_cast<PathsAnswer::Verdict>(state[0].cast<int>()),
                               state[1].cast<double>(), state[2].cast<double>(), state[3].cast<double>(),
                               state[4].cast<std::array<int, 2>>()};
          }))
      .def_property_readonly(
          "verdict",
          [](const PathsAnswer& a) {
            constexpr const char* kNames[] = {"clear", "touches", "close", "intersects_at_start",
                                              "undecided"};
            return kNames[static_cast<int>(a.verdict)];
          },
          "clear, touches, close, intersects_at_start or undecided.")
      .def_property_readonly(
          "span", [](const PathsAnswer& a) { return py::make_tuple(a.from, a.to); },
          "The two times that the verdict is about.")
      .def_readonly("within", &PathsAnswer::within, "Of close: the largest such distance.")
      .def_readonly("faces", &PathsAnswer::faces, "Two faces that come together, or -1, -1.")
      .def("__repr__", [](const py::object& self) {
        return "<cscd.PathsAnswer: " + std::string(py::str(self.attr("verdict"))) + ", " +
               std::string(py::str(self.attr("span"))) + ">";
      });

  py::class_<SelfCollision>(module, "SelfCollision")
      .def(py::init([](const Table<int>& faces, const Reals& reference, int threads, bool check_positions,
                       bool check_start, const SelfCollision::Exclusions& exclude, const Surfaces& obstacles,
                       const std::string& preparation, std::vector<int> labels, double thickness,
                       std::vector<double> vertex_thickness) {
             SelfCollision::Options options{threads,
                                            check_positions,
                                            check_start,
                                            exclude,
                                            {},
                                            {},
                                            std::move(labels),
                                            thickness,
                                            std::move(vertex_thickness)};
             const auto* const bytes = reinterpret_cast<const std::byte*>(preparation.data());
             options.preparation.assign(bytes, bytes + preparation.size());
             for (const auto& [corners, positions] : obstacles)
               options.obstacles.emplace_back(view(corners), view(positions));
             return std::make_unique<SelfCollision>(view(faces), view(reference), std::move(options));
           }),
           kWithoutLock)
      .def(
          "place_obstacle",
          [](SelfCollision& self, int obstacle, const Reals& positions) {
            self.place_obstacle(index_of(obstacle), view(positions));
          },
          kWithoutLock)
      .def(
          "move_obstacle",
          [](SelfCollision& self, int obstacle, const Reals& start, const Reals& end) {
            self.move_obstacle(index_of(obstacle), view(start), view(end));
          },
          kWithoutLock)
      .def(
          "is_free",
          [](SelfCollision& self, const Reals& start, const Reals& end) {
            return self.is_free(view(start), view(end));
          },
          kWithoutLock)
      .def(
          "first_contact",
          [](SelfCollision& self, const Reals& start, const Reals& end) {
            return self.first_contact(view(start), view(end));
          },
          kWithoutLock)
      .def(
          "all_contacts",
          [](SelfCollision& self, const Reals& start, const Reals& end) {
            return self.all_contacts(view(start), view(end));
          },
          kWithoutLock)
      .def(
          "largest_step",
          [](SelfCollision& self, const Reals& start, const Reals& end, double safety) {
            return self.largest_step(view(start), view(end), safety);
          },
          kWithoutLock)
      .def("candidates",
           [](SelfCollision& self, const Reals& start, const Reals& end, double radius) {
             SelfCollision::Candidates found;
             {
               const py::gil_scoped_release without_lock;
               found = self.candidates(view(start), view(end), radius);
             }
             return py::make_tuple(table_of(found.vertex_face), table_of(found.edge_edge));
           })
      .def("vertex_bounds",
           [](SelfCollision& self, const Reals& positions, double cap) {
             std::vector<double> bounds;
             {
               const py::gil_scoped_release without_lock;
               bounds = self.vertex_bounds(view(positions), cap);
             }
             return array_of(bounds);
           })
      .def(
          "crossings",
          [](SelfCollision& self, const Reals& positions) { return self.crossings(view(positions)); },
          kWithoutLock)
      .def("true_motion",  // the functions need the lock
           [](SelfCollision& self, std::function<std::vector<double>(double)> positions,
              std::function<std::vector<double>(double, double)> acceleration, double from, double to,
              double position_error, double resolution) {
             return self.true_motion({std::move(positions), std::move(acceleration), position_error}, from,
                                     to, resolution);
           })
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
