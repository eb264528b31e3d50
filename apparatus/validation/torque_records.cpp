// Torque records: the paper's site test, and a cement paste's static yield stress over rest.

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "apparatus/scene/load.hpp"
#include "apparatus/validation/validation.hpp"
#include "rheometer/protocol/protocol.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"
#include "rheometer/regression/statistics.hpp"

namespace tremie::validation {
namespace {

// --- the site's decay -------------------------------------------------------------------------------------

// As printed: 2 to 1.25 N m in about 10 s. Mix, speed and rest are not.
constexpr double site_start = 2.0, site_end = 1.25, site_time = 10.0;
const char* const no_site = "none: mix unknown";

/// Mix A after 240 s of rest at 0.25 rev/s, the gated kinetics.
CouetteDecay mix_a_decay(double alpha) {
  const double tau_0 = 54.0, A_thix = 1.3, rest = 240.0;
  CouetteFlow flow{{tau_0, 35.8}, {A_thix, GatedKinetics{alpha}, A_thix * rest / tau_0}, {}, {}};
  flow.omega = 0.5 * std::numbers::pi;
  return thixotropic_couette(flow, std::vector<double>{0.0, site_time});
}

void compare_site(Section& section) {
  for (const double alpha : {0.01, 0.0358}) {
    const auto torque = mix_a_decay(alpha).torque;
    if (alpha == 0.01)
      section.comparisons.push_back(
          {"site, torque at the start", "N m", site_start, NAN, torque.front(), NAN, no_site});
    section.comparisons.push_back({fmt::format("site, torque ratio after 10 s, α = {}", alpha), "",
                                   site_end / site_start, NAN, torque.back() / torque.front(), NAN, no_site});
  }
}

// --- the paste's static yield stress ----------------------------------------------------------------------

std::string record_file() {
  for (const auto& folder : scene::data_folders()) {
    const auto file = folder / "rheocem" / "SYS_0.55_250_1.csv";
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) return file.string();
  }
  throw std::runtime_error("reference_data/rheocem is not there ($TREMIE_DATA names its folder)");
}

/// Half-width of a 95 % interval over the peak: the source's averaged records have a standard deviation of 11 %.
constexpr double peak_scatter = 0.21;

/// Each rest but the first three is forecast from those before it.
void compare_paste(Section& section) {
  const std::string file = record_file();
  FitInput input;
  input.instrument = {0.02, 0.06, 0.05};
  const auto reading = read_protocol(parse_protocol_record(read_text_file(file), file), input);
  const auto &rest = reading.structuration.rest, &stress = reading.structuration.stress;
  for (std::size_t next = 3; next < rest.size(); ++next) {
    const auto end = static_cast<std::ptrdiff_t>(next);
    const StraightLine line =
        straight_line({rest.begin(), rest.begin() + end}, {stress.begin(), stress.begin() + end});
    section.comparisons.push_back({fmt::format("paste after {:.0f} s", rest[next]), "Pa", stress[next],
                                   peak_scatter * stress[next], line.at(rest[next]),
                                   line.half_width_of_reading(rest[next])});
    section.comparisons.back().what += ", line";
    const auto saturating =
        saturation_of({rest.begin(), rest.begin() + end + 1}, {stress.begin(), stress.begin() + end + 1});
    if (saturating && saturating->forecast_of_longest)
      section.comparisons.push_back({fmt::format("paste after {:.0f} s, saturating", rest[next]), "Pa",
                                     stress[next], peak_scatter * stress[next],
                                     *saturating->forecast_of_longest, NAN});
  }
  const std::vector<BreakdownTime>& times = reading.breakdown.times;
  const auto &rate = reading.breakdown.rate, &exponent = reading.breakdown.exponent;
  if (rate && exponent && exponent->ci95)
    section.findings.push_back(
        fmt::format("Half of the paste's excess torque is lost after {:.1f} s at 40 rpm and {:.1f} to {:.1f} "
                    "s at 0.115 rpm: k γ̇^a with a = {:.2f} [{:.2f}, {:.2f}], k = {:.2f} 1/s{}. With a = 1 "
                    "the lower speed would take 348 times as long.",
                    times.front().half_time, times.back().half_time, times[1].half_time, exponent->value,
                    exponent->ci95->low, exponent->ci95->high, rate->value,
                    reading.breakdown.modes.empty() ? "" : " for the mode of the largest share"));
  if (reading.structuration.early && reading.structuration.late)
    section.findings.push_back(
        fmt::format("The paste gains {:.1f} Pa/s between its first two rests, {:.1f} between its last: every "
                    "line overshoots.",
                    *reading.structuration.early, *reading.structuration.late));
}

}  // namespace

Section torque_records(const Settings& settings) {
  if (settings.stop && *settings.stop) throw Interrupted{};
  Section section{"torque", "Torque records",
                  "Site: the paper's test (2 to 1.25 N m in 10 s; mix and speed unknown) beside Mix A after "
                  "240 s in Couette flow at 0.25 rev/s. Paste: rheocem \"0.55\", static yield stress, "
                  "forecast from shorter rests by a line (Roussel's constant A_thix) and by saturating "
                  "structure; ± 21 % is twice the scatter of its source's averaged records."};
  compare_site(section);
  compare_paste(section);
  section.findings.push_back(
      "No single exponential fits the decay at 40 rpm; `tremie fit` gives no α (code 3).");
  return section;
}

}  // namespace tremie::validation
