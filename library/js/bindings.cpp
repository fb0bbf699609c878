// The functions that cscd.js calls. Numbers pass as arguments, arrays by the addresses of memory that
// JavaScript has allocated here and filled. What a question finds is written into two lists, one of integers
// and one of doubles, which JavaScript reads in the order in which it is written.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cscd/cscd.h"

#define CSCD_CALLED(name) extern "C" __attribute__((export_name(#name))) auto name
#define CSCD_CALLS(name) extern "C" __attribute__((import_module("cscd"), import_name(#name)))

namespace {

using cscd::SelfCollision;

// How the last call failed, until JavaScript has asked for it, and what the error says.
enum class Failure { none, invalid_argument, other } g_failure;
std::string g_text;

// What the last call found.
std::vector<std::int32_t> g_integers;
std::vector<double> g_numbers;

// Runs the call, and keeps the error that it throws.
template <class Call>
auto answered(const Call& call) -> decltype(call()) {
  g_integers.clear(), g_numbers.clear();
  const auto keep = [](Failure failure, const char* text) {
    g_failure = failure;
    g_text = text;
    return decltype(call())();
  };
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    return keep(Failure::invalid_argument, error.what());
  } catch (const std::exception& error) {
    return keep(Failure::other, error.what());
  }
}

void write(int n) {
  g_integers.push_back(n);
}
void write(std::size_t n) {
  g_integers.push_back(static_cast<std::int32_t>(n));
}
void write(double n) {
  g_numbers.push_back(n);
}
void write(const Eigen::Vector3d& v) {
  g_numbers.insert(g_numbers.end(), v.data(), v.data() + 3);
}
template <std::size_t kCount>
void write(const std::array<int, kCount>& row) {
  g_integers.insert(g_integers.end(), row.begin(), row.end());
}

void write(const SelfCollision::Crossings::Curve& curve);
void write(const SelfCollision::Crossings::Region& region);
void write(const SelfCollision::Crossings::Overlap& overlap);

// Writes how many rows there are, and then the rows.
template <class Row>
void write(const std::vector<Row>& rows) {
  write(rows.size());
  for (const Row& row : rows) write(row);
}

void write(const SelfCollision::Answer& answer) {
  write(answer.start_crossings);
  write(answer.contacts.size());
  // One array of all contacts after the other.
  const auto all = [&](auto member) {
    for (const SelfCollision::Contact& contact : answer.contacts) write(contact.*member);
  };
  using Contact = SelfCollision::Contact;
  for (const Contact& contact : answer.contacts) write(static_cast<int>(contact.edges));
  all(&Contact::vertices), all(&Contact::face);
  all(&Contact::time), all(&Contact::point), all(&Contact::normal), all(&Contact::weights);
  all(&Contact::normal_velocity);
}

void write(const SelfCollision::Crossings::Curve& curve) {
  write(curve.faces), write(curve.points), write(static_cast<int>(curve.closed));
}

void write(const SelfCollision::Crossings::Region& region) {
  write(region.bounds), write(region.vertices), write(region.way), write(region.distance);
  write(static_cast<int>(region.behind)), write(static_cast<int>(region.other_is_open)),
      write(region.deepest);
  write(region.area), write(region.depth), write(region.depth_bound), write(region.out);
}

void write(const SelfCollision::Crossings::Overlap& overlap) {
  write(overlap.curves), write(overlap.regions), write(overlap.vertices), write(overlap.gradient);
  write(overlap.depth), write(overlap.depth_bound), write(overlap.length);
}

using Corners = std::span<const std::uint32_t>;
using Numbers = std::span<const double>;

std::vector<std::pair<int, int>> pairs_of(std::span<const int> ids) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t i = 0; i + 1 < ids.size(); i += 2) pairs.emplace_back(ids[i], ids[i + 1]);
  return pairs;
}

}  // namespace

CSCD_CALLED(allocate)(std::size_t bytes)->void* {
  return answered([&] { return ::operator new(bytes); });
}
CSCD_CALLED(release)(void* memory)->void {
  ::operator delete(memory);
}

CSCD_CALLED(failure)()->int {
  return static_cast<int>(std::exchange(g_failure, Failure::none));
}
CSCD_CALLED(text)()->const char* {
  return g_text.data();
}
CSCD_CALLED(text_size)()->std::size_t {
  return g_text.size();
}
CSCD_CALLED(integers)()->const std::int32_t* {
  return g_integers.data();
}
CSCD_CALLED(numbers)()->const double* {
  return g_numbers.data();
}

// Options are gathered before an object is made of them.
CSCD_CALLED(options_make)()->SelfCollision::Options* {
  return answered([] { return std::make_unique<SelfCollision::Options>().release(); });
}
CSCD_CALLED(options_drop)(SelfCollision::Options* options)->void {
  std::unique_ptr<SelfCollision::Options>{options};
}

// Options of one number have its name, and those of an array have its name, its address and its size.
#define CSCD_NUMBER(name, member)                                                  \
  CSCD_CALLED(set_##name)(SelfCollision::Options * options, double number)->void { \
    options->member = static_cast<decltype(options->member)>(number);              \
  }
#define CSCD_ARRAY(name, member, Number)                                                                    \
  CSCD_CALLED(set_##name)(SelfCollision::Options * options, const Number* first, std::size_t count)->void { \
    answered([&] { options->member.assign(first, first + count); });                                        \
  }
#define CSCD_PAIRS(name, member)                                                                         \
  CSCD_CALLED(set_##name)(SelfCollision::Options * options, const int* first, std::size_t count)->void { \
    answered([&] { options->member = pairs_of({first, count}); });                                       \
  }
CSCD_NUMBER(check_positions, check_positions)
CSCD_NUMBER(check_start, check_start)
CSCD_NUMBER(thickness, thickness)
CSCD_NUMBER(rings, exclude.rings)
CSCD_NUMBER(rest_distance, exclude.rest_distance)
CSCD_NUMBER(ongoing, exclude.ongoing)
CSCD_ARRAY(vertex_thickness, vertex_thickness, double)
CSCD_ARRAY(labels, labels, int)
CSCD_ARRAY(preparation, preparation, std::byte)
CSCD_ARRAY(rigid, exclude.rigid, std::uint8_t)
CSCD_ARRAY(group, exclude.group, int)
CSCD_PAIRS(groups_that_ignore_each_other, exclude.groups_that_ignore_each_other)
CSCD_PAIRS(vertex_pairs, exclude.vertex_pairs)
CSCD_PAIRS(face_pairs, exclude.face_pairs)

CSCD_CALLED(add_obstacle)
(SelfCollision::Options* options, const std::uint32_t* faces, std::size_t corners, const double* positions,
 std::size_t numbers)
    ->void {
  answered([&] { options->obstacles.emplace_back(Corners(faces, corners), Numbers(positions, numbers)); });
}

CSCD_CALLED(make)
(const std::uint32_t* faces, std::size_t corners, const double* reference, std::size_t numbers,
 SelfCollision::Options* options)
    ->SelfCollision* {
  return answered([&] {
    return std::make_unique<SelfCollision>(Corners(faces, corners), Numbers(reference, numbers),
                                           std::move(*options))
        .release();
  });
}
CSCD_CALLED(drop)(SelfCollision* body)->void {
  std::unique_ptr<SelfCollision>{body};
}

CSCD_CALLED(vertex_count)(const SelfCollision* body)->std::size_t {
  return body->vertex_count();
}
CSCD_CALLED(face_count)(const SelfCollision* body)->std::size_t {
  return body->face_count();
}
CSCD_CALLED(closed)(const SelfCollision* body)->bool {
  return body->closed();
}

// A step: the positions before, and after.
#define CSCD_STEP const double *start, std::size_t start_count, const double *end, std::size_t end_count
#define CSCD_START Numbers(start, start_count)
#define CSCD_END Numbers(end, end_count)

CSCD_CALLED(place_obstacle)
(SelfCollision* body, std::size_t obstacle, const double* positions, std::size_t count)->void {
  answered([&] { body->place_obstacle(obstacle, Numbers(positions, count)); });
}
CSCD_CALLED(move_obstacle)(SelfCollision* body, std::size_t obstacle, CSCD_STEP)->void {
  answered([&] { body->move_obstacle(obstacle, CSCD_START, CSCD_END); });
}
CSCD_CALLED(is_free)(SelfCollision* body, CSCD_STEP)->bool {
  return answered([&] { return body->is_free(CSCD_START, CSCD_END); });
}
CSCD_CALLED(first_contact)(SelfCollision* body, CSCD_STEP)->void {
  answered([&] { write(body->first_contact(CSCD_START, CSCD_END)); });
}
CSCD_CALLED(all_contacts)(SelfCollision* body, CSCD_STEP)->void {
  answered([&] { write(body->all_contacts(CSCD_START, CSCD_END)); });
}
CSCD_CALLED(largest_step)(SelfCollision* body, CSCD_STEP, double safety)->double {
  return answered([&] { return body->largest_step(CSCD_START, CSCD_END, safety); });
}
CSCD_CALLED(candidates)(SelfCollision* body, CSCD_STEP, double radius)->void {
  answered([&] {
    const SelfCollision::Candidates found = body->candidates(CSCD_START, CSCD_END, radius);
    write(found.vertex_face), write(found.edge_edge);
  });
}
CSCD_CALLED(vertex_bounds)
(SelfCollision* body, const double* positions, std::size_t count, double cap)->void {
  answered([&] { g_numbers = body->vertex_bounds(Numbers(positions, count), cap); });
}
CSCD_CALLED(crossings)(SelfCollision* body, const double* positions, std::size_t count)->void {
  answered([&] {
    const SelfCollision::Crossings found = body->crossings(Numbers(positions, count));
    write(found.overlaps), write(found.touching);
  });
}
CSCD_CALLED(preparation)(const SelfCollision* body)->void {
  answered([&] {
    const std::vector<std::byte> bytes = body->preparation();
    write(bytes.size());
    for (const std::byte byte : bytes) write(static_cast<int>(byte));
  });
}

// JavaScript's functions of vertices that do not move in straight lines. Each fills a list, by way of
// resize(), and returns whether it did; an error of its own is thrown again by cscd.js.
CSCD_CALLS(path_positions) bool path_positions(double time, std::vector<double>& out);
CSCD_CALLS(path_acceleration) bool path_acceleration(double from, double to, std::vector<double>& out);
CSCD_CALLED(resize)(std::vector<double>* list, std::size_t size)->double* {
  return answered([&] { return list->resize(size), list->data(); });
}
CSCD_CALLED(true_motion)
(SelfCollision* body, double position_error, double from, double to, double resolution)->void {
  answered([&] {
    const auto filled = [](auto function, auto... times) {
      std::vector<double> out;
      if (!function(times..., out)) throw std::runtime_error("a function of the caller has thrown an error");
      return out;
    };
    const SelfCollision::PathsAnswer answer = body->true_motion(
        {.positions = [&](double time) { return filled(path_positions, time); },
         .acceleration = [&](double first, double last) { return filled(path_acceleration, first, last); },
         .position_error = position_error},
        from, to, resolution);
    write(static_cast<int>(answer.verdict)), write(answer.faces);
    write(answer.from), write(answer.to), write(answer.within);
  });
}
