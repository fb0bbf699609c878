#pragma once

#include <gtest/gtest.h>
#include <string>

#include "core/base/error.h"

namespace cscd::test {

// Returns the text of the error that `act` throws, which has to be one line; empty where it throws none.
template <class Error = InputError, class Act>
std::string refusal(const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

}  // namespace cscd::test
