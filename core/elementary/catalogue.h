#pragma once

#include <span>
#include <string_view>

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// Every elementary test that this project has: the published ones and our own.
std::span<const ElementaryTest> elementary_tests();

// Returns the test of that name, or null when there is none.
const ElementaryTest* find_elementary_test(std::string_view name);

}  // namespace cscd
