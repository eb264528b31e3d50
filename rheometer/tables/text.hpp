#pragma once

#include <cstdio>
#include <string>

namespace tremie {

/// The values as printf writes them, up to 400 characters.
template <class... Values>
std::string text_of(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace tremie
