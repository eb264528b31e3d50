#pragma once

// What the studies of the rheometer write at the head of their tables, and how they call gnuplot.

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "tremie_version.hpp"

namespace tremie::study {

inline std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

/// "tremie 0.2.0 (commit), GNU 12.2.0, one core of …. Made by `…`."
inline std::string made_by(const std::string& target) {
  return "tremie " + std::string(version) + " (" + commit + "), " + compiler + ", one core of " +
         processor() + ".\nMade by `ninja -C build/release " + target + "`.";
}

/// Runs gnuplot on a script of this folder.
inline void draw(const std::string& directory, const std::string& script) {
  if (std::system(("cd '" + directory + "' && gnuplot " + script).c_str()) != 0)
    std::cerr << "gnuplot failed: no chart of " << script << '\n';
}

}  // namespace tremie::study
