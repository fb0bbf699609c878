#pragma once

#include <gtest/gtest.h>
#include <string>

namespace cscd::scenes {

// Tells whether a text contains these words. Where it does not, a test that fails shows both.
inline testing::AssertionResult says(const std::string& text, const std::string& words) {
  if (text.find(words) != text.npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << text << "' does not say '" << words << "'";
}

}  // namespace cscd::scenes
