// Prints a digest of the answers to random steps, bit by bit, and the processor time that they took:
// scripts/check isas compares instruction sets by it, and scripts/check threads numbers of threads.
//
//   digest SOUPS STEPS [THREADS]
//
// SOUPS is the number of small random surfaces that take one step each. STEPS is the number of steps in which
// a closed tube of 12,800 triangles bends. THREADS answer together; without it, one.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string_view>

#include "cscd/cscd.h"

namespace {

using Faces = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
using cscd::SelfCollision;

struct Digest {
  std::uint64_t hash = 0xcbf29ce484222325u;
  std::size_t contacts = 0;

  void add(std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number + 0.0)); }
  void add(const SelfCollision::Answer& answer) {
    for (const auto& [a, b] : answer.start_crossings) add(std::uint64_t(a)), add(std::uint64_t(b));
    for (const SelfCollision::Contact& contact : answer.contacts) {
      for (const int v : contact.vertices) add(std::uint64_t(v));
      add(contact.time), add(contact.normal_velocity);
      for (int k = 0; k < 3; ++k) add(contact.point[k]), add(contact.normal[k]), add(contact.weights[k]);
    }
    contacts += answer.contacts.size();
  }
  template <class Pairs>
  void add_in_order(Pairs pairs) {
    std::sort(pairs.begin(), pairs.end());
    for (const auto& pair : pairs)
      for (const int v : pair) add(std::uint64_t(v));
    add(std::uint64_t(pairs.size()));
  }
  void ask(SelfCollision& body, const Positions& start, const Positions& end) {
    add(std::uint64_t(body.is_free(start, end)));
    add(body.first_contact(start, end));
    add(body.all_contacts(start, end));
    add(body.largest_step(start, end));
    const SelfCollision::Candidates near = body.candidates(start, end, 0.01);
    add_in_order(near.vertex_face), add_in_order(near.edge_edge);
    for (const double bound : body.vertex_bounds(start, 0.05)) add(bound);
  }
};

void ask_soups(int count, const SelfCollision::Options& options, Digest& sum) {
  std::mt19937_64 draw(1);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int i = 0; i < count; ++i) {
    Faces faces(20, 3);
    for (Eigen::Index f = 0; f < faces.rows(); ++f) faces.row(f) << int(f), int(f) + 1, int(f) + 2;
    Positions start(22, 3), end(22, 3);
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      start.data()[k] = place(draw);
      end.data()[k] = start.data()[k] + 0.1 * place(draw);
    }
    SelfCollision body(faces, start, options);
    sum.ask(body, start, end);
  }
}

// Errors are thrown by a copy of the engine and caught here.
void ask_what_is_wrong(Digest& sum) {
  Faces faces(1, 3);
  faces << 0, 1, 2;
  SelfCollision body(faces, Positions::Identity(3, 3));
  try {
    body.is_free(Positions::Identity(3, 3), Positions::Zero(4, 3));
  } catch (const std::invalid_argument& error) {
    for (const char* c = error.what(); *c != '\0'; ++c) sum.add(std::uint64_t(*c));
    return;
  }
  throw std::runtime_error("a wrong size is taken");
}

// The last bits of sine and cosine differ among C libraries, and within one where a processor lacks FMA.
// Everybody has to be asked about the same positions, so both are rounded to 24 places behind the point.
double rounded(double number) {
  return std::round(number * 0x1p24) * 0x1p-24;
}
double cosine(double turns) {
  return rounded(std::cos(2 * std::numbers::pi * turns));
}
double sine(double turns) {
  return rounded(std::sin(2 * std::numbers::pi * turns));
}

// A closed ring of `around` by `along` quads, two triangles each, which bends to an eight as `phase` grows.
Positions ring(int around, int along, double phase) {
  Positions out(around * along, 3);
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const double u = double(i) / along, v = double(j) / around;
      const double r = 1 + 0.1 * cosine(v) - 0.9 * phase * cosine(u) * cosine(u);
      out.row(i * around + j) << r * cosine(u), 2 * sine(u), 0.1 * sine(v) + 0.02 * phase * i / along;
    }
  return out;
}

void ask_ring(int steps, const SelfCollision::Options& options, Digest& sum) {
  constexpr int kAround = 32, kAlong = 200;
  Faces faces(2 * kAround * kAlong, 3);
  for (int i = 0; i < kAlong; ++i)
    for (int j = 0; j < kAround; ++j) {
      const int a = i * kAround + j, b = i * kAround + (j + 1) % kAround;
      const int c = (a + kAround) % (kAround * kAlong), d = (b + kAround) % (kAround * kAlong);
      faces.row(2 * a) << a, c, b;
      faces.row(2 * a + 1) << b, c, d;
    }
  SelfCollision::Options prepared = options;
  prepared.preparation = SelfCollision(faces, ring(kAround, kAlong, 0), options).preparation();
  SelfCollision body(faces, ring(kAround, kAlong, 0), prepared);
  for (int i = 0; i < steps; ++i)
    sum.ask(body, ring(kAround, kAlong, double(i) / steps), ring(kAround, kAlong, double(i + 1) / steps));
}

double processor_ms() {
  return 1e3 * double(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

int main(int count, char** words) try {
  SelfCollision::Options options;
  if (count > 3) options.threads = std::atoi(words[3]);
  Digest sum;
  ask_what_is_wrong(sum);
  ask_soups(count > 1 ? std::atoi(words[1]) : 100, options, sum);
  const double soups = processor_ms();
  ask_ring(count > 2 ? std::atoi(words[2]) : 10, options, sum);
  std::printf("%016llx, %zu contacts\n", static_cast<unsigned long long>(sum.hash), sum.contacts);
  const std::string_view set = cscd::instruction_set();
  std::fprintf(stderr, "%.*s: %.0f ms and %.0f ms\n", int(set.size()), set.data(), soups,
               processor_ms() - soups);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "digest: %s\n", error.what());
  return 2;
}
