#pragma once

#include "core/base/instruction_set.h"

#include "cscd/cscd.h"

// One binary for every x86-64. The whole engine, the functions of cscd.h included, is compiled once for each
// instruction set. scripts/cmake/instruction_sets.cmake links each *copy* to one object and hides all of its
// names but one, so that no function compiled for one instruction set, nor an inline one of a header, can
// stand in for that of another. The one name is a table of the functions of cscd.h, through which the front
// calls the copy.
namespace cscd {

// Nothing crosses this border whose layout depends on the instruction set: SelfCollision is one pointer, and
// the others are made of numbers, standard containers, and matrices that Eigen does not align.
struct Copy {
  using Positions = SelfCollision::Positions;
  using Answer = SelfCollision::Answer;

  InstructionSet set;
  SelfCollision* (*make)(const SelfCollision::Faces&, const Positions&, SelfCollision::Options&&);
  void (*destroy)(SelfCollision*);
  void (SelfCollision::*place_obstacle)(std::size_t, const Positions&);
  void (SelfCollision::*move_obstacle)(std::size_t, const Positions&, const Positions&);
  bool (SelfCollision::*is_free)(const Positions&, const Positions&);
  void (SelfCollision::*first_contact)(const Positions&, const Positions&, Answer&);
  void (SelfCollision::*all_contacts)(const Positions&, const Positions&, Answer&);
  double (SelfCollision::*largest_step)(const Positions&, const Positions&, double);
  SelfCollision::Candidates (SelfCollision::*candidates)(const Positions&, const Positions&, double);
  std::vector<double> (SelfCollision::*vertex_bounds)(const Positions&, double);
  SelfCollision::Crossings (SelfCollision::*crossings)(const Positions&);
  SelfCollision::PathsAnswer (SelfCollision::*true_motion)(const SelfCollision::Paths&, double, double,
                                                           double);
  std::vector<std::byte> (SelfCollision::*preparation)() const;
  std::size_t (SelfCollision::*vertex_count)() const;
  std::size_t (SelfCollision::*face_count)() const;
  bool (SelfCollision::*closed)() const;
};

}  // namespace cscd

extern "C" {
extern const cscd::Copy cscd_copy_avx512, cscd_copy_avx2, cscd_copy_baseline;
}
