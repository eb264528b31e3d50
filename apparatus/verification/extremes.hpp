#pragma once

// Stiff and extreme scenes, each judged by physics: no case may end in a silent wrong number.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/outcome.hpp"

namespace tremie::verification {

/// How a scene ended.
enum class Ending {
  right,        ///< exit 0, and physics has nothing against it
  flagged,      ///< exit 3, with its reason
  no_meaning,   ///< exit 2, with its reason
  too_slow,     ///< stopped after its time: not judged
  silent_wrong  ///< exit 0 against physics, or exit 3 without a reason
};

struct Extreme {
  std::string family;                  ///< "slump: m over yield stress"
  std::string name;                    ///< what is extreme: "m = 1e6 s, 54 Pa"
  std::string scene;                   ///< TOML
  std::vector<std::string> overrides;  ///< as --set
  /// What physics has against the outcome; empty: nothing.
  std::function<std::string(const scene::Outcome&)> against;
  /// Cases of one family with the same key are put in order by `rank`, and `reading` must not grow along it.
  std::string monotone_key = {};
  double rank = 0.0;
  std::string reading = {};  ///< name of a result: "spread_mm"
};

struct Verdict {
  Ending ending = Ending::right;
  std::string why;                ///< the reason, or what physics has against it
  std::optional<double> reading;  ///< of Extreme::reading
  double cpu = 0.0;               ///< [s]
};

/// All cases; at least 200.
std::vector<Extreme> extremes();

/// Runs one, for at most `limit` seconds of CPU.
Verdict judge(const Extreme& extreme, double limit);

/// Turns a right verdict into a wrong one where a reading grows along its rank by more than 2 %.
void judge_monotony(const std::vector<Extreme>& cases, std::vector<Verdict>& verdicts);

}  // namespace tremie::verification
