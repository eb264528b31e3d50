#pragma once

// A study whose runs are done in a moment.

#include <string>

#include "tests/apparatus/temporary_folder.hpp"

namespace tremie::test {

inline void write_quick_study(const TemporaryFolder& folder, const std::string& design) {
  write_file(folder / "quick.toml",
             "apparatus = \"slump_flow\"\nmix = \"mix_c\"\n[test]\nduration = \"0.1 s\"\nlift_speed = "
             "\"instant\"\n[model]\ncell = \"20 mm\"\npoints_per_cell = 2\n");
  write_file(
      folder / "STUDY.toml",
      "base = \"quick.toml\"\n[[factor]]\nkey = \"mix.yield_stress\"\nrange = [\"20 Pa\", \"200 "
      "Pa\"]\nscale = \"log\"\n[[factor]]\nkey = \"test.rest\"\nvalues = [\"0 s\", \"60 s\"]\n[design]\n" +
          design + "[read]\nresults = [\"spread_mm\", \"t500_s\"]\n");
}

/// study.csv without its last column, the time that each run took.
inline std::string without_cpu(const std::string& csv) {
  std::string text;
  for (std::size_t start = 0; start < csv.size();) {
    const auto end = csv.find('\n', start);
    const std::string line = csv.substr(start, end - start);
    text += line.substr(0, line.rfind(',')) + "\n";
    start = end + 1;
  }
  return text;
}

}  // namespace tremie::test
