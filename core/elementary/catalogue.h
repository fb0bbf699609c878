#pragma once

#include <span>
#include <string_view>

#include "core/elementary/question/elementary_test.h"

namespace cscd {

// All elementary tests of this project: the published tests and our own. The span is valid for the whole run.
std::span<const ElementaryTest> elementary_tests();

// Returns the test of that name, or null when there is none.
const ElementaryTest* find_elementary_test(std::string_view name);

}  // namespace cscd
