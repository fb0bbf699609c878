#pragma once

#include <version>

#include "cscd/export.h"

// Standard containers, which pass between a program and the library, have another layout with _GLIBCXX_DEBUG,
// and another one in libc++. A program whose containers differ from the library's would end in undefined
// behaviour. So each source that includes cscd.h refers to a name that only a library with the same
// containers defines, and otherwise the linker says that this name is missing.
#if defined(_LIBCPP_VERSION)
#define CSCD_CONTAINERS cscd_library_compiled_with_libcxx
#elif defined(_GLIBCXX_DEBUG)
#define CSCD_CONTAINERS cscd_library_compiled_with_GLIBCXX_DEBUG
#else
#define CSCD_CONTAINERS cscd_library_compiled_without_GLIBCXX_DEBUG
#endif

#if defined(__GNUC__)
#if __has_attribute(retain) && \
    !defined(_WIN32)  // the linker then keeps the reference with --gc-sections, too
#define CSCD_RETAINED __attribute__((used, retain))
#else
#define CSCD_RETAINED __attribute__((used))
#endif
extern "C" CSCD_EXPORT const char CSCD_CONTAINERS;
namespace cscd {
CSCD_RETAINED static const char* const containers_of_this_source = &CSCD_CONTAINERS;
}  // namespace cscd
#endif
