#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "library/engine/engine.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

// An engine that this binary holds.
struct Built {
  InstructionSet set;
  decltype(&make_engine<kCompiledFor>) make;
};
using enum InstructionSet;
#if defined(CSCD_ALL_ISAS)
constexpr std::array kBuilt = {Built{avx512, make_engine<avx512>}, Built{avx2, make_engine<avx2>},
                               Built{baseline, make_engine<baseline>}};
#else
constexpr std::array kBuilt = {Built{kCompiledFor, make_engine<kCompiledFor>}};
#endif

const Built& choose() {
  std::array<InstructionSet, kBuilt.size()> sets;
  std::ranges::transform(kBuilt, sets.begin(), &Built::set);
  return *std::ranges::find(kBuilt, chosen_among(sets), &Built::set);
}

// The choice is made once a process. If it fails, the next call makes it again.
const Built& chosen() {
  static const Built& choice = choose();
  return choice;
}

// Returns what differs from thread to thread. Standard libraries without threads have no std::thread::id.
const void* this_thread() {
  thread_local const char here = 0;
  return &here;
}

// Holds an object for one call, and throws where another call holds it: that of another thread, or the call
// of this thread that is asking a function of the caller for positions or for a bound.
class Turn {
 public:
  explicit Turn(std::atomic<const void*>& asked_by) : asked_by_(asked_by) {
    const void* const own = this_thread();
    const void* holder = nullptr;
    if (asked_by_.compare_exchange_strong(holder, own, std::memory_order_acquire, std::memory_order_relaxed))
      return;
    throw std::logic_error(
        holder == own ? "this SelfCollision is being asked by true_motion(), and a function given to that "
                        "asks the same object; ask another object there"
                      : "this SelfCollision is answering another thread; give each thread one of its own");
  }
  ~Turn() { asked_by_.store(nullptr, std::memory_order_release); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic<const void*>& asked_by_;
};

// What an object holds, unless it has been moved from.
SelfCollision::Engine& held(const std::unique_ptr<SelfCollision::Engine>& engine) {
  if (!engine)
    throw std::invalid_argument("this SelfCollision has been moved from; use the one it was moved to");
  return *engine;
}

// Asks an object's engine by one of its methods, unless a call is asking it already.
template <class Method, class... Arguments>
auto ask(const std::unique_ptr<SelfCollision::Engine>& engine, Method method, Arguments&&... arguments) {
  SelfCollision::Engine& own = held(engine);
  const Turn turn(own.asked_by);
  return (own.*method)(std::forward<Arguments>(arguments)...);
}

}  // namespace

std::string_view instruction_set() {
  return to_string(chosen().set);
}

SelfCollision::SelfCollision(const Faces& faces, const Positions& reference, Options options)
    : engine_(chosen().make(faces, reference, std::move(options))) {}
SelfCollision::~SelfCollision() = default;
SelfCollision::SelfCollision(SelfCollision&&) noexcept = default;
SelfCollision& SelfCollision::operator=(SelfCollision&&) noexcept = default;

void SelfCollision::place_obstacle(std::size_t obstacle, const Positions& positions) {
  ask(engine_, &Engine::place_obstacle, obstacle, positions);
}
void SelfCollision::move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end) {
  ask(engine_, &Engine::move_obstacle, obstacle, start, end);
}
bool SelfCollision::is_free(const Positions& start, const Positions& end) {
  return ask(engine_, &Engine::is_free, start, end);
}
void SelfCollision::first_contact(const Positions& start, const Positions& end, Answer& out) {
  ask(engine_, &Engine::first_contact, start, end, out);
}
void SelfCollision::all_contacts(const Positions& start, const Positions& end, Answer& out) {
  ask(engine_, &Engine::all_contacts, start, end, out);
}
double SelfCollision::largest_step(const Positions& start, const Positions& end, double safety) {
  return ask(engine_, &Engine::largest_step, start, end, safety);
}
SelfCollision::Candidates SelfCollision::candidates(const Positions& start, const Positions& end,
                                                    double radius) {
  return ask(engine_, &Engine::candidates, start, end, radius);
}
std::vector<double> SelfCollision::vertex_bounds(const Positions& positions, double cap) {
  return ask(engine_, &Engine::vertex_bounds, positions, cap);
}
SelfCollision::Crossings SelfCollision::crossings(const Positions& positions) {
  return ask(engine_, &Engine::crossings, positions);
}
SelfCollision::PathsAnswer SelfCollision::true_motion(const Paths& paths, double from, double to,
                                                      double resolution) {
  return ask(engine_, &Engine::true_motion, paths, from, to, resolution);
}
std::vector<std::byte> SelfCollision::preparation() const {
  return ask(engine_, &Engine::preparation);
}

std::size_t SelfCollision::vertex_count() const {
  return held(engine_).vertex_count();
}
std::size_t SelfCollision::face_count() const {
  return held(engine_).face_count();
}
bool SelfCollision::closed() const {
  return held(engine_).closed();
}

}  // namespace cscd
