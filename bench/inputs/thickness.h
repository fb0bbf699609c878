#pragma once

#include <string>

#include "bench/inputs/input.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// Sets Input::thickness. Whoever leaves out what the input ignores before it is tested says so by
// `with_ignored`. Throws InputError where a length overflows.
void set_thickness(Input& input, const ThicknessRequest& request, bool with_ignored = false);

// What the lengths of an input are measured in, once set_thickness() has measured its edges.
LengthScale length_scale(const Input& input);
// Throws InputError, naming the option, where a length was written with a unit and the input does not tell
// its own.
void require_unit(const Input& input, const WrittenLength& written, const char* option);

// "12.3 cm", "4.56 mm" or "1.23 m" where the input tells its unit, else "0.0123".
std::string distance_text(const Input& input, double length);

// Throws InputError, naming those that can, where a strategy or an elementary test cannot answer the request:
// because it knows no distance, or cannot leave pairs out.
void require_fit(const ThicknessRequest& request, const Strategy& strategy);
void require_fit(const ThicknessRequest& request, const ElementaryTest& elementary);
// Says what a strategy lacks for the request; empty where it lacks nothing.
std::string why_not_within(const ThicknessRequest& request, const Strategy& strategy);

// The feature pairs that are close in the pose at rest, sorted; by the complete reference and an exact test.
// What is `left_out` is not decided; null for nothing.
ContactSet close_at_rest(const Input& input, const Exclusions* left_out = nullptr);

}  // namespace cscd::bench
