#pragma once

#include <cstddef>
#include <span>

namespace cscd {

// Reads each cache line of some memory, so that a caller who soon needs all of it in random order does not
// wait for every line by itself. It loads instead of prefetching, because a processor may drop a prefetch
// where it does not know the page.
template <class T>
void warm_cache(std::span<const T> items) {
  constexpr std::size_t kLine = 64;
  const std::span<const std::byte> bytes = std::as_bytes(items);
  for (std::size_t i = 0; i < bytes.size(); i += kLine)
    static_cast<void>(*static_cast<const volatile std::byte*>(&bytes[i]));
}

}  // namespace cscd
