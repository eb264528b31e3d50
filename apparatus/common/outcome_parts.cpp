#include "apparatus/common/outcome_parts.hpp"

#include <fmt/format.h>

#include <limits>

namespace tremie::scene {

double or_nan(std::optional<double> value) {
  return value.value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string stopped_line(std::optional<double> stopped_at, Status status) {
  if (stopped_at) return fmt::format("stopped at      {:.2f} s", *stopped_at);
  return fmt::format("stopped         {}", still_moving(status));
}

const char* still_moving(Status status) {
  if (status == Status::interrupted) return "not yet when the run was interrupted";
  if (status == Status::failed) return "not yet when the run failed";
  return "not within the time of the test (test.duration)";
}

std::vector<std::string> flocculation_lines(std::optional<double> start, std::optional<double> end) {
  if (!start || !end) return {};
  return {fmt::format("flocculation    {:.3g} at the start, {:.3g} at the end", *start, *end)};
}

std::string flocculation_use(const Mix& mix) {
  return mix.thixotropy ? "flocculation: stored and updated at every point"
                        : "flocculation: left out (no [mix.thixotropy]): not stored, not computed";
}

void add_model_uses(const Model& model, std::vector<std::string>& lines) {
  lines.push_back(is_exact(model.law) ? "regularisation: left out (exact yield)"
                                      : "regularisation: of the yield law");
  lines.push_back(model.transfer == TransferKind::flip ? "FLIP blend: in the transfer"
                                                       : "FLIP blend: left out (model.transfer = \"apic\")");
  if (model.scheme != SchemeKind::implicit)
    lines.push_back(model.precision == PrecisionKind::single_sums
                        ? "sums between points and grid: in single precision; points in double"
                        : "sums between points and grid: in double precision");
}

std::string asked_text(const std::string& mix_name, const std::string& test, double rest) {
  const std::string mix = mix_name.empty() ? "The mix" : mix_name;
  return rest > 0.0 ? fmt::format("{}, {} after {:g} s of rest", mix, test, rest)
                    : fmt::format("{}, {} without rest", mix, test);
}

ResultValue word_or_null(const std::string& word) {
  if (word.empty()) return std::monostate{};
  return word;
}

}  // namespace tremie::scene
