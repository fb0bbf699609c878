#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "core/base/instruction_set.h"

#include "cscd/cscd.h"

namespace cscd {

// Answers the questions of one SelfCollision, each as cscd.h promises it, for one thread at a time.
//
// One binary may hold engines for several instruction sets. Everything behind this interface is compiled once
// for each set, and scripts/cmake/instruction_sets.cmake hides all names of such a copy but that of
// make_engine(), so that no function compiled for one set, nor an inline one of a header, can stand in for
// that of another. Nothing passes here whose layout depends on the set: what passes are numbers, standard
// containers, and matrices that Eigen does not align.
class SelfCollision::Engine {
 public:
  class Prepared;  // prepared_engine.h

  std::atomic<const void*> asked_by = nullptr;  // the thread whose call is being answered

  virtual ~Engine() = default;
  virtual void place_obstacle(std::size_t obstacle, const Positions& positions) = 0;
  virtual void move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end) = 0;
  virtual bool is_free(const Positions& start, const Positions& end) = 0;
  virtual void first_contact(const Positions& start, const Positions& end, Answer& out) = 0;
  virtual void all_contacts(const Positions& start, const Positions& end, Answer& out) = 0;
  virtual double largest_step(const Positions& start, const Positions& end, double safety) = 0;
  virtual Candidates candidates(const Positions& start, const Positions& end, double radius) = 0;
  virtual std::vector<double> vertex_bounds(const Positions& positions, double cap) = 0;
  virtual Crossings crossings(const Positions& positions) = 0;
  virtual PathsAnswer true_motion(const Paths& paths, double from, double to, double resolution) = 0;
  virtual std::vector<std::byte> preparation() const = 0;
  virtual std::size_t vertex_count() const = 0;
  virtual std::size_t face_count() const = 0;
  virtual bool closed() const = 0;
};

// Prepares an engine that is compiled for `set`. Each copy of the engine defines this for its own set.
template <InstructionSet set>
std::unique_ptr<SelfCollision::Engine> make_engine(const SelfCollision::Faces& faces,
                                                   const SelfCollision::Positions& reference,
                                                   SelfCollision::Options options);

}  // namespace cscd
