#include <array>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "library/dispatch/copy.h"
#include "library/held.h"

// The functions of cscd.h in a build for all instruction sets. Each hands the call on to the copy that is
// used.
namespace cscd {
namespace {

const Copy& copy_for(InstructionSet set) {
  switch (set) {
    case InstructionSet::avx512:
      return cscd_copy_avx512;
    case InstructionSet::avx2:
      return cscd_copy_avx2;
    case InstructionSet::baseline:
      break;
  }
  return cscd_copy_baseline;
}

const Copy& choose_copy() {
  using enum InstructionSet;
  try {
    return copy_for(chosen_among(std::array{avx512, avx2, baseline}));
  } catch (const InputError& error) {
    throw std::invalid_argument(error.what());
  }
}

// The choice is made once a process. If it fails, the next call makes it again.
const Copy& chosen_copy() {
  static const Copy& chosen = choose_copy();
  return chosen;
}

}  // namespace

// Here an engine is an object that a copy has made. A copy knows another class by this name, its own.
class SelfCollision::Engine {
 public:
  Engine(const Faces& faces, const Positions& reference, Options&& options)
      : copy_(chosen_copy()), body_(copy_.make(faces, reference, std::move(options))) {}
  ~Engine() { copy_.destroy(body_); }
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  template <class Member, class... Arguments>
  decltype(auto) call(Member Copy::*member, Arguments&&... arguments) const {
    return (body_->*(copy_.*member))(std::forward<Arguments>(arguments)...);
  }

 private:
  const Copy& copy_;
  SelfCollision* body_;
};

SelfCollision::SelfCollision(const Faces& faces, const Positions& reference, Options options)
    : engine_(std::make_unique<Engine>(faces, reference, std::move(options))) {}
SelfCollision::~SelfCollision() = default;
SelfCollision::SelfCollision(SelfCollision&&) noexcept = default;
SelfCollision& SelfCollision::operator=(SelfCollision&&) noexcept = default;

void SelfCollision::place_obstacle(std::size_t obstacle, const Positions& positions) {
  held(engine_).call(&Copy::place_obstacle, obstacle, positions);
}
void SelfCollision::move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end) {
  held(engine_).call(&Copy::move_obstacle, obstacle, start, end);
}

bool SelfCollision::is_free(const Positions& start, const Positions& end) {
  return held(engine_).call(&Copy::is_free, start, end);
}

void SelfCollision::first_contact(const Positions& start, const Positions& end, Answer& out) {
  held(engine_).call(&Copy::first_contact, start, end, out);
}

void SelfCollision::all_contacts(const Positions& start, const Positions& end, Answer& out) {
  held(engine_).call(&Copy::all_contacts, start, end, out);
}

double SelfCollision::largest_step(const Positions& start, const Positions& end, double safety) {
  return held(engine_).call(&Copy::largest_step, start, end, safety);
}

SelfCollision::Candidates SelfCollision::candidates(const Positions& start, const Positions& end,
                                                    double radius) {
  return held(engine_).call(&Copy::candidates, start, end, radius);
}

std::vector<double> SelfCollision::vertex_bounds(const Positions& positions, double cap) {
  return held(engine_).call(&Copy::vertex_bounds, positions, cap);
}
SelfCollision::PathsAnswer SelfCollision::true_motion(const Paths& paths, double from, double to,
                                                      double resolution) {
  return held(engine_).call(&Copy::true_motion, paths, from, to, resolution);
}

SelfCollision::Crossings SelfCollision::crossings(const Positions& positions) {
  return held(engine_).call(&Copy::crossings, positions);
}

std::vector<std::byte> SelfCollision::preparation() const {
  return held(engine_).call(&Copy::preparation);
}

std::size_t SelfCollision::vertex_count() const {
  return held(engine_).call(&Copy::vertex_count);
}
std::size_t SelfCollision::face_count() const {
  return held(engine_).call(&Copy::face_count);
}
bool SelfCollision::closed() const {
  return held(engine_).call(&Copy::closed);
}

std::string_view instruction_set() {
  return to_string(chosen_copy().set);
}

}  // namespace cscd
