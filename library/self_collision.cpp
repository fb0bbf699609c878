#include <algorithm>
#include <atomic>
#include <optional>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/instruction_set.h"
#include "core/base/number_text.h"
#include "library/engine.h"
#include "library/held.h"

#include "cscd/cscd.h"

namespace cscd {
namespace {

// Runs the call, and turns errors of the input into the library's.
template <class Call>
auto checked(const Call& call) {
  try {
    return call();
  } catch (const InputError& error) {
    throw std::invalid_argument(error.what());
  }
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

// Asks an object, unless a call is asking it already.
template <class Engine, class Call>
auto ask(const std::unique_ptr<Engine>& engine, const Call& call) {
  Engine& own = held(engine);
  const Turn turn(own.asked_by);
  return checked([&] { return call(own); });
}

}  // namespace

SelfCollision::SelfCollision(const Faces& faces, const Positions& reference, Options options)
    : engine_(checked([&] {
        // Throws if it cannot be what the environment asks for. Asked once: the choice holds for the process.
        [[maybe_unused]] static const std::string_view chosen = instruction_set();
        return std::make_unique<Engine>(faces, reference, std::move(options));
      })) {}
SelfCollision::~SelfCollision() = default;
SelfCollision::SelfCollision(SelfCollision&&) noexcept = default;
SelfCollision& SelfCollision::operator=(SelfCollision&&) noexcept = default;

void SelfCollision::place_obstacle(std::size_t obstacle, const Positions& positions) {
  ask(engine_, [&](Engine& engine) { engine.move(obstacle, positions, positions); });
}

void SelfCollision::move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end) {
  ask(engine_, [&](Engine& engine) { engine.move(obstacle, start, end); });
}

bool SelfCollision::is_free(const Positions& start, const Positions& end) {
  return ask(engine_, [&](Engine& engine) { return engine.is_free(engine.motion(start, end)); });
}

void SelfCollision::first_contact(const Positions& start, const Positions& end, Answer& out) {
  ask(engine_, [&](Engine& engine) {
    const Motion motion = engine.motion(start, end);
    engine.step(motion, true);
    engine.write(motion, out);
  });
}

void SelfCollision::all_contacts(const Positions& start, const Positions& end, Answer& out) {
  ask(engine_, [&](Engine& engine) {
    const Motion motion = engine.motion(start, end);
    engine.step(motion, false);
    engine.write(motion, out);
  });
}

double SelfCollision::largest_step(const Positions& start, const Positions& end, double safety) {
  return ask(engine_, [&](Engine& engine) {
    if (!(safety > 0 && safety <= 1))
      throw InputError("largest_step: safety " + exact_text(safety) + "; give a number in (0, 1]");
    const std::optional<double> time = engine.free_until(engine.motion(start, end));
    if (!time) return 1.0;
    return safety * *time;
  });
}

SelfCollision::Candidates SelfCollision::candidates(const Positions& start, const Positions& end,
                                                    double radius) {
  return ask(engine_, [&](Engine& engine) {
    Candidates out;
    const Motion motion = engine.motion(start, end);
    engine.check_finite(motion.start(), "start positions");
    engine.check_finite(motion.end(), "end positions");
    engine.candidates(motion, radius, out);
    return out;
  });
}

std::vector<double> SelfCollision::vertex_bounds(const Positions& positions, double cap) {
  return ask(engine_, [&](Engine& engine) { return engine.vertex_bounds(engine.pose(positions), cap); });
}

SelfCollision::Crossings SelfCollision::crossings(const Positions& positions) {
  return ask(engine_, [&](Engine& engine) { return engine.crossings(engine.pose(positions)); });
}

SelfCollision::PathsAnswer SelfCollision::true_motion(const Paths& paths, double from, double to,
                                                      double resolution) {
  return ask(engine_, [&](Engine& engine) { return engine.true_motion(paths, from, to, resolution); });
}

std::vector<std::byte> SelfCollision::preparation() const {
  return ask(engine_, [](const Engine& engine) { return engine.preparation(); });
}

std::size_t SelfCollision::vertex_count() const {
  return held(engine_).mesh().vertex_count();
}
std::size_t SelfCollision::face_count() const {
  return held(engine_).mesh().triangle_count();
}
bool SelfCollision::closed() const {
  return held(engine_).mesh().closed_and_oriented();
}

}  // namespace cscd
