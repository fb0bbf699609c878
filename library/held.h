#pragma once

#include <memory>
#include <stdexcept>

namespace cscd {

// What an object holds, unless it has been moved from.
template <class Engine>
Engine& held(const std::unique_ptr<Engine>& engine) {
  if (!engine)
    throw std::invalid_argument("this SelfCollision has been moved from; use the one it was moved to");
  return *engine;
}

}  // namespace cscd
