// Whether breakdown takes time or strain: what 240 s of rest take from the spreads of Mixes A to C, by the exponent a of the
// shear rate in dlambda/dt = A_thix/tau_0 - k gamma_dot^a lambda. k is not fitted: the torque on site decays with 0.43 1/s at
// 12.43 1/s. The exponent of two mixes forecasts the third's loss.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/validation/mixes.hpp"
#include "apparatus/validation/readings.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::validation {
namespace {

using report::Curve;

constexpr double site_rate = 0.43, site_shear_rate = 12.43;  ///< [1/s], the paper's vane
constexpr double by_strain = 1.0, of_the_mixes = 0.1;        ///< the mixes' files have it
constexpr std::array exponents{0.03, of_the_mixes, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, by_strain};
constexpr double loss_error = 42.4;  ///< of a difference of two spreads, each +/- 30 mm
constexpr double to_deviation = 1.0 / 1.96;

/// The kinetics of one pair of runs, the rest as the mix has it.
struct Variant {
  double a = of_the_mixes, k_factor = 1.0, gate = 0.0, A_thix_factor = 1.0;
  bool friction = false, with_error = false;
};
struct MixData {
  double A_thix;  ///< Table 1 [Pa/s]
};
constexpr MixData of_mix[] = {{1.3}, {1.8}, {2.9}};

Ask ask(std::size_t mix, bool rested, const Variant& v) {
  Ask asked{fmt::format("apparatus = \"slump_flow\"\nmix = \"{}\"\n[test]\nrest = \"{} s\"\n",
                        paper_mix[mix].file, rested ? 240 : 0),
            "spread_mm"};
  const auto set = [&](const char* key, const std::string& value) {
    asked.overrides.push_back(fmt::format("mix.thixotropy.{}={}", key, value));
  };
  set("kinetics", "rate_power");
  set("rate_exponent", fmt::format("{}", v.a));
  set("breakdown_rate", fmt::format("{:.6g} 1/s", v.k_factor * site_rate / std::pow(site_shear_rate, v.a)));
  set("structuration_rate", fmt::format("{:.6g} Pa/s", v.A_thix_factor * of_mix[mix].A_thix));
  if (v.gate > 0.0) set("critical_shear_rate", fmt::format("{} 1/s", v.gate));
  if (v.friction)
    asked.scene +=
        fmt::format("[floor]\ncontact = \"friction\"\ncoefficient = {}\n", paper_mix[mix].friction);
  asked.with_error = v.with_error;
  return asked;
}

using Losses = std::array<double, 3>;  ///< of Mixes A to C [mm]

/// The losses of each variant; those with an error have it in `errors`.
std::vector<Losses> losses_of(const std::vector<Variant>& variants, const Settings& settings,
                              Losses* errors = nullptr) {
  std::vector<Ask> asked;
  for (const Variant& v : variants)
    for (std::size_t mix = 0; mix < 3; ++mix)
      for (const bool rested : {false, true}) asked.push_back(ask(mix, rested, v));
  const auto readings = read_scenes(asked, settings);
  std::vector<Losses> losses(variants.size());
  for (std::size_t i = 0; i < readings.size(); i += 2) {
    losses[i / 6][i / 2 % 3] = readings[i].value - readings[i + 1].value;
    if (errors && variants[i / 6].with_error)
      (*errors)[i / 2 % 3] = std::hypot(readings[i].error, readings[i + 1].error);
  }
  return losses;
}

double measured_loss(std::size_t mix) { return paper_mix[mix].fresh - paper_mix[mix].rested; }

/// Loss of a mix at an exponent, linear between those that were run.
double loss_at(const std::vector<Losses>& losses, std::size_t mix, double a) {
  std::size_t i = 1;
  while (i + 1 < exponents.size() && exponents[i] < a) ++i;
  const double share = (a - exponents[i - 1]) / (exponents[i] - exponents[i - 1]);
  return losses[i - 1][mix] + share * (losses[i][mix] - losses[i - 1][mix]);
}

double chi_squared(const std::vector<Losses>& losses, std::size_t mix, double a) {
  const double by = (loss_at(losses, mix, a) - measured_loss(mix)) / (loss_error * to_deviation);
  return by * by;
}

/// Values over a from 0.03 to 1, each as likely as the mixes but `left_out` make it, at their quantiles.
template <class Value>
std::array<double, 3> quantiles(const std::vector<Losses>& losses, std::size_t left_out, Value value) {
  std::vector<std::pair<double, double>> weighed;
  double sum = 0.0;
  for (int i = 0; i <= 970; ++i) {
    const double a = 0.03 + 0.001 * i;
    double squares = 0.0;
    for (std::size_t mix = 0; mix < 3; ++mix)
      if (mix != left_out) squares += chi_squared(losses, mix, a);
    weighed.emplace_back(value(a), std::exp(-0.5 * squares));
    sum += weighed.back().second;
  }
  std::sort(weighed.begin(), weighed.end());
  std::array<double, 3> result{};
  const double at[] = {0.025, 0.5, 0.975};
  double below = 0.0;
  std::size_t next = 0;
  for (const auto& [v, weight] : weighed) {
    below += weight / sum;
    for (; next < 3 && below >= at[next]; ++next) result[next] = v;
  }
  return result;
}

void draw(const std::vector<Losses>& losses, const std::filesystem::path& file) {
  report::LineChart chart{.title = "Spread lost by 240 s of rest",
                          .x_label = "exponent a of the shear rate",
                          .y_label = "spread lost (mm)",
                          .levels = {{"measured", 17.0, loss_error}},
                          .width = 640,
                          .height = 420};
  for (std::size_t mix = 0; mix < 3; ++mix) {
    Curve curve{.label = paper_mix[mix].name};
    for (std::size_t i = 0; i < exponents.size(); ++i)
      curve.x.push_back(exponents[i]), curve.y.push_back(losses[i][mix]);
    chart.curves.push_back(curve);
  }
  io::write_text(file, report::svg_file({chart}));
}

std::string table(const std::vector<Losses>& losses) {
  std::string head = "|a|", line = "|---|", rows[3];
  for (std::size_t mix = 0; mix < 3; ++mix) rows[mix] = fmt::format("|{}|", paper_mix[mix].name);
  for (std::size_t i = 0; i < exponents.size(); ++i) {
    head += fmt::format("{}|", exponents[i]), line += "---|";
    for (std::size_t mix = 0; mix < 3; ++mix) rows[mix] += fmt::format("{:.0f}|", losses[i][mix]);
  }
  return "\n\n" + head + "measured|\n" + line + "---|\n" + rows[0] + "15|\n" + rows[1] + "20|\n" + rows[2] +
         "15|\n";
}

/// What moves the losses at the exponent of the mixes.
std::string what_moves_them(const Settings& settings) {
  const std::pair<const char*, Variant> others[] = {
      {"k halved", {.k_factor = 0.5}},        {"k doubled", {.k_factor = 2.0}},
      {"0.7 A_thix", {.A_thix_factor = 0.7}}, {"1.3 A_thix", {.A_thix_factor = 1.3}},
      {"gate 0.003 1/s", {.gate = 0.003}},    {"gate 0.01 1/s", {.gate = 0.01}},
      {"gate 0.1 1/s", {.gate = 0.1}},        {"the paper's friction", {.friction = true}}};
  std::vector<Variant> variants;
  for (const auto& other : others) variants.push_back(other.second);
  const auto losses = losses_of(variants, settings);
  std::string text;
  for (std::size_t i = 0; i < losses.size(); ++i)
    text += fmt::format("{}{} {:.0f}, {:.0f}, {:.0f}", i == 0 ? "" : "; ", others[i].first, losses[i][0],
                        losses[i][1], losses[i][2]);
  return text;
}

}  // namespace

Section breakdown_of_pairs(const Settings& settings) {
  std::vector<Variant> variants;
  for (const double a : exponents) variants.push_back({.a = a, .with_error = a == of_the_mixes});
  Losses errors{};
  const auto losses = losses_of(variants, settings, &errors);
  draw(losses, settings.folder / "breakdown.svg");
  Section section{"breakdown", "Breakdown by time or by strain",
                  "dλ/dt = A_thix/τ0 − k γ̇^a λ without gate and slip, every other value as printed. k γ̇^a is "
                  "0.43 1/s at 12.43 1/s, from the paper's torque on site; a = 1 is Roussel's equation. A "
                  "measured loss (mm) is the difference of two spreads." +
                      table(losses) + "\n![Spread lost over the exponent](breakdown.svg)"};
  for (std::size_t mix = 0; mix < 3; ++mix) {
    const auto loss = [&](double a) { return loss_at(losses, mix, a); };
    const auto by_others = quantiles(losses, mix, loss);
    const Comparison measured{"", "mm", measured_loss(mix), loss_error};
    for (const double a : {of_the_mixes, by_strain}) {
      Comparison c = measured;
      c.what = fmt::format("{}, a = {}", paper_mix[mix].name, a);
      c.predicted = loss(a);
      c.predicted_error = a == of_the_mixes ? errors[mix] : NAN;
      section.comparisons.push_back(c);
    }
    Comparison c = measured;
    c.what = fmt::format("{}, a of the two others", paper_mix[mix].name);
    c.predicted = 0.5 * (by_others[0] + by_others[2]);
    c.predicted_error = 0.5 * (by_others[2] - by_others[0]);
    section.comparisons.push_back(c);
  }
  const auto a = quantiles(losses, 3, [](double x) { return x; });
  double best = INFINITY, at_one = 0.0;
  for (int i = 0; i <= 970; ++i) {
    double squares = 0.0;
    for (std::size_t mix = 0; mix < 3; ++mix) squares += chi_squared(losses, mix, 0.03 + 0.001 * i);
    best = std::min(best, squares);
    at_one = squares;
  }
  section.findings.push_back(
      fmt::format("All three mixes give a below {:.2f} (97.5 %; median {:.2f}; uniform prior from 0.03 to 1, "
                  "k fixed); a = 1 "
                  "is less likely than the best by e^−{:.0f}. A model in which rest has no effect fits "
                  "equally well: the losses bound a from above alone.",
                  a[2], a[1], 0.5 * (at_one - best)));
  section.findings.push_back(
      fmt::format("Losses of Mixes A, B, C at a = {} with one change (mm): ", of_the_mixes) +
      what_moves_them(settings) + ".");
  return section;
}

}  // namespace tremie::validation
