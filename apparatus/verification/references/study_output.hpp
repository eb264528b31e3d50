#pragma once

// What the studies write at the head of their tables, and their charts.

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "apparatus/report/page/charts.hpp"
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

/// A curve over the rows of a table, to be filled.
inline report::Curve curve(const std::string& label, report::Mark mark = report::Mark::line) {
  return {.label = label, .mark = mark};
}

inline void add_point(report::Curve& curve, double x, double y) {
  curve.x.push_back(x), curve.y.push_back(y);
}

}  // namespace tremie::study
