// The public header with meshes, steps and options of any kind: shapes, layouts, types, indices and numbers.
// The target decides by itself whether the input is right. What is right is answered as all pairs of features
// say, and what is wrong is refused with one line.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "baselines/plain.h"
#include "core/elementary/catalogue.h"
#include "fuzz/numbers.h"

#include "cscd/cscd.h"

namespace cscd::fuzz {
namespace {

using Eigen::Dynamic;
using Eigen::Index;
template <class Scalar>
using ByRow = Eigen::Matrix<Scalar, Dynamic, Dynamic, Eigen::RowMajor>;
template <class Scalar>
using ByColumn = Eigen::Matrix<Scalar, Dynamic, Dynamic>;

constexpr int kMostVertices = 9, kMostFaces = 8;

// Nearly always the usual thing, so that inputs with one fault are common and right ones are too.
bool is_odd(Numbers& numbers) {
  return numbers.byte() >= 250;
}

double any_double(Numbers& numbers) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits = bits << 8 | numbers.byte();
  return std::bit_cast<double>(bits);
}

Index any_count(Numbers& numbers, Index usual) {
  return is_odd(numbers) ? numbers.byte() % 7 : usual;
}

// Calls take(x) with the matrix in one of the layouts that a caller may have it in.
template <class Scalar, class Take>
void in_any_layout(Numbers& numbers, const ByRow<Scalar>& matrix, const Take& take) {
  switch (numbers.byte() % 6) {
    case 0:
      return take(matrix);
    case 1:
      return take(ByColumn<Scalar>(matrix));
    case 2: {
      const ByColumn<Scalar> turned = matrix.transpose();
      return take(turned.transpose());
    }
    case 3: {
      ByRow<Scalar> wide = ByRow<Scalar>::Constant(matrix.rows() + 2, matrix.cols() + 2, Scalar(1));
      wide.block(1, 1, matrix.rows(), matrix.cols()) = matrix;
      return take(wide.block(1, 1, matrix.rows(), matrix.cols()));
    }
    case 4:
      if (matrix.cols() == 3) return take(std::vector<Scalar>(matrix.data(), matrix.data() + matrix.size()));
      return take(matrix);
    default:
      return take(matrix.colwise().reverse().colwise().reverse());
  }
}

struct Surface {
  ByRow<long long> faces;
  ByRow<double> positions;

  // Whether the library has to take this surface.
  bool right() const {
    if (faces.cols() != 3 || faces.rows() == 0 || positions.cols() != 3 || !positions.allFinite())
      return false;
    for (Index f = 0; f < faces.rows(); ++f) {
      for (int k = 0; k < 3; ++k)
        if (faces(f, k) < 0 || faces(f, k) >= positions.rows() || faces(f, k) == faces(f, (k + 1) % 3))
          return false;
    }
    return true;
  }
};

ByRow<double> any_positions(Numbers& numbers, Index rows) {
  ByRow<double> out(any_count(numbers, rows), any_count(numbers, 3));
  const bool wild = is_odd(numbers);  // exact arithmetic takes long for numbers of all sizes
  for (Index i = 0; i < out.size(); ++i)
    out.data()[i] = wild && numbers.byte() % 2 == 0 ? any_double(numbers) : numbers.coordinate();
  return out;
}

Surface any_surface(Numbers& numbers) {
  const Index vertices = 3 + numbers.byte() % (kMostVertices - 2);
  ByRow<long long> faces(any_count(numbers, 1 + numbers.byte() % kMostFaces), any_count(numbers, 3));
  for (Index f = 0; f < faces.rows(); ++f)
    for (Index k = 0; k < faces.cols(); ++k) {
      const long long first = k > 0 ? faces(f, 0) : 0;
      faces(f, k) = is_odd(numbers) ? std::bit_cast<long long>(any_double(numbers)) >> numbers.byte() % 64
                                    : (k == 0 ? numbers.byte() : first + k + numbers.byte() % 2) % vertices;
    }
  return {faces, any_positions(numbers, vertices)};
}

// Runs the call. Returns whether it was refused, which it must be just where the input is wrong.
bool refused(bool right, const std::string& what, const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    if (right) broken(what + " refuses what is right: " + text);
    if (text.empty() || text.find('\n') != std::string::npos) broken(what + " says not one line: " + text);
    return true;
  }
  if (!right) broken(what + " takes what is wrong");
  return false;
}

bool names_pairs_below(const std::vector<std::pair<int, int>>& pairs, Index count) {
  return std::ranges::all_of(pairs, [&](const auto& pair) {
    return pair.first >= 0 && pair.first < count && pair.second >= 0 && pair.second < count;
  });
}

int any_index(Numbers& numbers, Index count) {
  return is_odd(numbers) ? static_cast<int>(std::bit_cast<std::uint64_t>(any_double(numbers)))
                         : static_cast<int>(numbers.byte() % (count + 1)) - (is_odd(numbers) ? 1 : 0);
}

// Fills in exclusions of up to `vertices` vertices and `faces` faces. Returns whether they are right.
bool any_exclusions(Numbers& numbers, Index vertices, Index faces, SelfCollision::Exclusions& out) {
  bool right = true;
  const auto pairs = [&](Index count) {
    std::vector<std::pair<int, int>> made;
    for (int left = numbers.byte() % 5; left > 0; --left)
      made.emplace_back(any_index(numbers, count - 1), any_index(numbers, count - 1));
    return made;
  };
  switch (numbers.byte() % 7) {
    case 0:
      out.vertex_pairs = pairs(vertices);
      return names_pairs_below(out.vertex_pairs, vertices);
    case 1:
      out.face_pairs = pairs(faces);
      return names_pairs_below(out.face_pairs, faces);
    case 2:
      out.rings = is_odd(numbers) ? static_cast<int>(std::bit_cast<std::uint64_t>(any_double(numbers)))
                                  : numbers.byte() % 4;
      return out.rings >= 0;
    case 3:
      out.rest_distance = is_odd(numbers) ? any_double(numbers) : std::abs(numbers.coordinate());
      return out.rest_distance >= 0 && std::isfinite(out.rest_distance);
    case 4:
      for (Index v = any_count(numbers, vertices); v > 0; --v) out.rigid.push_back(numbers.byte() % 2);
      return out.rigid.empty() || static_cast<Index>(out.rigid.size()) == vertices;
    case 5:
      out.ongoing = true;
      return true;
    default: {
      for (Index v = any_count(numbers, vertices); v > 0; --v) out.group.push_back(any_index(numbers, 2));
      const auto [least, most] = std::ranges::minmax(out.group.empty() ? std::vector{0} : out.group);
      right = static_cast<Index>(out.group.size()) == vertices && least >= 0 && most < 4096;
      out.groups_that_ignore_each_other = pairs(3);
      if (out.group.empty()) return out.groups_that_ignore_each_other.empty();
      return right && names_pairs_below(out.groups_that_ignore_each_other, Index{most} + 1);
    }
  }
}

std::vector<Vec3> points(const ByRow<double>& positions) {
  std::vector<Vec3> out;
  for (Index v = 0; v < positions.rows(); ++v)
    out.emplace_back(positions(v, 0), positions(v, 1), positions(v, 2));
  return out;
}

// The contacts of a step by a look at all pairs of features.
ContactSet all_pairs(const Surface& surface, const ByRow<double>& start, const ByRow<double>& end) {
  std::vector<Triangle> triangles;
  for (Index f = 0; f < surface.faces.rows(); ++f) {
    Triangle corners;
    for (int k = 0; k < 3; ++k)
      corners[static_cast<std::size_t>(k)] = VertexId{static_cast<std::int32_t>(surface.faces(f, k))};
    triangles.push_back(corners);
  }
  const std::vector<Vec3> reference = points(surface.positions), from = points(start), to = points(end);
  const TriangleMesh mesh(triangles, reference.size());
  const StrategyInput setup{mesh, reference, nullptr, *find_elementary_test("filtered_exact")};
  const Motion motion(from, to);
  ContactSet found;
  make_brute(setup).detector->detect({motion}, found);
  found.sort();
  return found;
}

void hold_to_all_pairs(SelfCollision& body, const Surface& surface, const ByRow<double>& start,
                       const ByRow<double>& end, bool excludes) {
  const SelfCollision::Answer all = body.all_contacts(start, end), first = body.first_contact(start, end);
  const ContactSet truth = all_pairs(surface, start, end);
  if (excludes ? all.contacts.size() > truth.contacts.size() : all.contacts.size() != truth.contacts.size())
    broken("all_contacts() has other contacts than all pairs");
  for (std::size_t i = 0; !excludes && i < all.contacts.size(); ++i)
    if (all.contacts[i].time != truth.contacts[i].time) broken("all_contacts() has another time");
  if (first.time() != all.time()) broken("first_contact() has another time than all_contacts()");
  if (body.is_free(start, end) != all.free()) broken("is_free() is at odds with all_contacts()");
  const double step = body.largest_step(start, end, 1);
  if (all.intersects_at_start() ? step != 0 : step > all.time().value_or(1))
    broken("largest_step() goes too far");
  const SelfCollision::Candidates near = body.candidates(start, end, 0);
  if (near.vertex_face.size() + near.edge_edge.size() < all.contacts.size())
    broken("candidates() lacks what touches");
}

}  // namespace

void target(Bytes bytes) {
  Numbers numbers(bytes);
  const Surface surface = any_surface(numbers);
  SelfCollision::Options options;
  // A reference pose that was never filled in is refused.
  const auto is_first = [&](const auto& row) { return row == surface.positions.row(0); };
  const bool collapsed = surface.faces.rows() > 1 && surface.positions.rows() > 0 &&
                         std::ranges::all_of(surface.positions.rowwise(), is_first);
  bool right = surface.right() && !collapsed;
  if (is_odd(numbers)) {
    options.threads =
        numbers.byte() % 2 ? static_cast<std::int8_t>(numbers.byte()) : 1 << numbers.byte() % 31;
    right = right && options.threads >= 1 && options.threads <= 1024;
  }
  Index vertices = surface.positions.rows(), faces = surface.faces.rows();
  std::optional<Surface> beside;
  if (numbers.byte() % 4 == 0) {
    beside = any_surface(numbers);
    if (numbers.byte() % 2 == 0)  // elsewhere, so that many steps meet no obstacle
      for (double* p = beside->positions.data(); p < beside->positions.data() + beside->positions.size(); ++p)
        *p += 300;
    bool taken = false;
    const bool refused_alone = refused(beside->faces.cols() == 3 && beside->positions.cols() == 3 &&
                                           (beside->faces.array() >= std::numeric_limits<int>::min()).all() &&
                                           (beside->faces.array() <= std::numeric_limits<int>::max()).all(),
                                       "Obstacle()", [&] {
                                         in_any_layout(numbers, beside->faces, [&](const auto& corners) {
                                           options.obstacles.emplace_back(corners, beside->positions);
                                         });
                                         taken = true;
                                       });
    if (refused_alone) return;
    right = right && taken && beside->right();
    vertices += beside->positions.rows(), faces += beside->faces.rows();
  }
  bool excludes = false;
  if (numbers.byte() % 4 == 0 && vertices > 0 && faces > 0) {
    excludes = true;
    right = any_exclusions(numbers, vertices, faces, options.exclude) &&
            (!options.exclude.ongoing || options.check_start) && right;
  }
  if (is_odd(numbers)) {  // bytes that were never a preparation
    for (int left = 1 + numbers.byte(); left > 0; --left)
      options.preparation.push_back(std::byte{numbers.byte()});
    right = false;
  }
  std::optional<SelfCollision> body;
  if (refused(right, "SelfCollision()", [&] {
        in_any_layout(numbers, surface.faces, [&](const auto& corners) {
          in_any_layout(numbers, surface.positions,
                        [&](const auto& reference) { body.emplace(corners, reference, options); });
        });
      }))
    return;
  if (numbers.byte() % 4 == 0) {  // its own preparation, with some byte changed or not
    options.preparation = body->preparation();
    const bool damage = numbers.byte() % 2 == 0;
    if (damage) options.preparation[numbers.byte() % options.preparation.size()] ^= std::byte{1};
    std::optional<SelfCollision> again;
    const auto make = [&] { again.emplace(surface.faces, surface.positions, options); };
    if (!refused(!damage, "a preparation", make)) body = std::move(again);
  }

  const ByRow<double> start =
      numbers.byte() % 2 == 0 ? surface.positions : any_positions(numbers, surface.positions.rows());
  const ByRow<double> end = any_positions(numbers, surface.positions.rows());
  const auto fits = [&](const ByRow<double>& pose, const ByRow<double>& like) {
    return pose.cols() == 3 && pose.rows() == like.rows() && pose.allFinite();
  };
  const bool step = fits(start, surface.positions) && fits(end, surface.positions);
  const auto with_step = [&](const auto& ask) {
    in_any_layout(numbers, start, [&](const auto& from) {
      in_any_layout(numbers, end, [&](const auto& to) { ask(from, to); });
    });
  };
  refused(step, "is_free()", [&] { with_step([&](const auto& a, const auto& b) { body->is_free(a, b); }); });
  refused(step, "all_contacts()",
          [&] { with_step([&](const auto& a, const auto& b) { body->all_contacts(a, b); }); });
  const double safety = is_odd(numbers) ? any_double(numbers) : 0.5;
  refused(step && safety > 0 && safety <= 1, "largest_step()",
          [&] { with_step([&](const auto& a, const auto& b) { body->largest_step(a, b, safety); }); });
  const double radius = is_odd(numbers) ? any_double(numbers) : std::abs(numbers.coordinate());
  refused(step && radius >= 0 && std::isfinite(radius), "candidates()",
          [&] { with_step([&](const auto& a, const auto& b) { body->candidates(a, b, radius); }); });
  const std::size_t which = numbers.byte() % 2;
  if (beside) {
    const ByRow<double> place = any_positions(numbers, beside->positions.rows());
    refused(which == 0 && fits(place, beside->positions), "move_obstacle()", [&] {
      in_any_layout(numbers, place, [&](const auto& to) {
        body->move_obstacle(which, beside->positions, to);
        body->place_obstacle(which, beside->positions);
      });
    });
  } else {
    refused(false, "place_obstacle()", [&] { body->place_obstacle(which, surface.positions); });
  }
  if (step && !beside) hold_to_all_pairs(*body, surface, start, end, excludes);
}

}  // namespace cscd::fuzz
