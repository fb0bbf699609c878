#pragma once

#include <cstddef>
#include <span>

namespace cscd {

// Reads one byte of every cache line of `items`, which brings the whole span into the cache. A caller
// that soon needs all of the items in random order calls this first, so that it need not wait for
// every line by itself. The lines are loaded, because a processor may drop a prefetch of a page whose
// address it has not translated.
template <class T>
void bring_near(std::span<const T> items) {
  constexpr std::size_t kLine = 64;
  const std::span<const std::byte> bytes = std::as_bytes(items);
  for (std::size_t i = 0; i < bytes.size(); i += kLine)
    static_cast<void>(*static_cast<const volatile std::byte*>(&bytes[i]));
}

}  // namespace cscd
