// Case 10: stiff and extreme scenes.

#include "apparatus/verification/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "apparatus/verification/suite.hpp"

namespace tremie::verification {
namespace {

const char* word_of(Ending ending) {
  return ending == Ending::right        ? "right"
         : ending == Ending::flagged    ? "exit 3"
         : ending == Ending::no_meaning ? "exit 2"
         : ending == Ending::too_slow   ? "stopped"
                                        : "**silent**";
}

/// One line without what a table cannot hold.
std::string table_cell(std::string text) {
  if (const auto end = text.find('\n'); end != std::string::npos) text.resize(end);
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

}  // namespace

Case extremes_case(Depth depth) {
  const double limit = depth == Depth::full ? 120.0 : 2.0;
  std::vector<Extreme> cases = extremes();
  if (depth == Depth::quick) {  // every seventh
    std::vector<Extreme> some;
    for (std::size_t i = 0; i < cases.size(); i += 7) some.push_back(cases[i]);
    cases = std::move(some);
  }
  std::vector<Verdict> verdicts;
  for (const Extreme& one : cases) verdicts.push_back(judge(one, limit));
  judge_monotony(cases, verdicts);
  Table table{.name = "Stiff and extreme scenes",
              .text = "",
              .columns = {"family", "case", "ends", "reading", "CPU s", "why"}};
  std::map<Ending, int> count;
  double cpu = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Verdict& v = verdicts[i];
    ++count[v.ending];
    cpu += v.cpu;
    table.rows.push_back({cases[i].family, cases[i].name, word_of(v.ending),
                          v.reading ? fmt::format("{:.4g}", *v.reading) : "", fmt::format("{:.2f}", v.cpu),
                          table_cell(v.why)});
  }
  table.text = fmt::format(
      "{} scenes in {:.0f} s of CPU: {} right, {} flagged as untrusted (exit 3), {} refused (exit 2), "
      "{} stopped after {:g} s, {} wrong without saying so. The reading is the spread in mm or the torque in "
      "N m.",
      cases.size(), cpu, count[Ending::right], count[Ending::flagged], count[Ending::no_meaning],
      count[Ending::too_slow], limit, count[Ending::silent_wrong]);
  table.bounds = {{.what = "scenes wrong without saying so",
                   .value = static_cast<double>(count[Ending::silent_wrong]),
                   .limit = 0.0}};
  return {10, "Stiff and extreme scenes", {}, {table}};
}

}  // namespace tremie::verification
