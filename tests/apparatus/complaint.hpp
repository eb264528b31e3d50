#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apparatus/registry/registry.hpp"

namespace tremie::test {

/// The message of a scene that must not be accepted; "" where it is.
inline std::string complaint(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    scene::read_text(text, "bad.toml", overrides);
  } catch (const scene::InputError& error) {
    return error.what();
  }
  return "";
}

inline ::testing::AssertionResult says(const std::string& message, const std::vector<std::string>& parts) {
  for (const auto& part : parts)
    if (message.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "\"" << part << "\" is not in: " << message;
  return ::testing::AssertionSuccess();
}

}  // namespace tremie::test
