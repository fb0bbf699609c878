#pragma once

#include "core/detect/strategy.h"

#include "cscd/cscd.h"

namespace cscd {

// Answers SelfCollision::true_motion() for the mesh of `setup`.
SelfCollision::PathsAnswer answer_paths(const SelfCollision::Paths& paths, double from, double to,
                                        double resolution, const StrategyInput& setup);

}  // namespace cscd
