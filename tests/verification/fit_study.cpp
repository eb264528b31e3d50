// What the fit of a torque record is worth: coverage of its 95 % intervals, the apparent alpha beside the
// fitted one, and the paper's site test.
//
//   fit_study DIR SITE.csv     writes fit_study.md, fit_apparent_alpha.csv and .svg into DIR

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "apparatus/verification/references/study_output.hpp"
#include "rheometer/regression/statistics.hpp"
#include "tests/verification/fit_coverage.hpp"

namespace tremie::study {
namespace {

constexpr int seeds = 200;
constexpr double noise = 0.02;

void write_coverage(std::ofstream& out, const char* record, const std::vector<Coverage>& coverage) {
  for (const Coverage& c : coverage)
    out << "| " << record << " | " << c.name << " | " << c.truth << " | " << median(c.values) << " | "
        << 100.0 * c.covered / seeds << " % | " << c.missing << " |\n";
}

/// Apparent values over the records, one list a window and rate, and the fitted alpha.
struct Apparent {
  std::vector<double> window{2.0, 5.0, 10.0, 20.0};
  std::vector<double> newtonian[4], vane[4], fitted;

  void add(const FitResult& f) {
    if (f.alpha) fitted.push_back(f.alpha->value);
    if (!f.apparent || f.apparent->windows.size() != 4) return;
    for (std::size_t i = 0; i < 4; ++i) {
      newtonian[i].push_back(f.apparent->windows[i].alpha_newtonian_rate);
      if (const auto& alpha = f.apparent->windows[i].alpha_rate_at_vane) vane[i].push_back(*alpha);
    }
  }
};

double quantile(std::vector<double> v, double p) {
  std::sort(v.begin(), v.end());
  return v.empty() ? NAN : v[static_cast<std::size_t>(p * static_cast<double>(v.size() - 1))];
}

void write_apparent(std::ofstream& out, const Apparent& a, const std::string& directory) {
  out << "\nalpha read the paper's way: the exponent of the apparent lambda over a window, divided by a "
         "nominal shear "
         "rate\n(lambda = 0 at the dynamic Reiner-Riwlin torque). Median of "
      << seeds << " records; truth " << synthetic::alpha << ", the fit's median " << median(a.fitted)
      << ".\n\n"
      << "| window | rate 2 Omega/(1 - Ri^2/Ro^2) = 3.91 1/s | rate at the vane at the start, about 10.2 1/s "
         "|\n|---|---|---|\n";
  std::ofstream csv(directory + "/fit_apparent_alpha.csv");
  csv << "window_s,newtonian_median,newtonian_low,newtonian_high,vane_median,vane_low,vane_high\n";
  report::LineChart chart{
      .title = "One concrete, one α (2 % noise; bars: 95 % of 200 records)",
      .x_label = "window of the record (s)",
      .y_label = "α",
      .curves = {curve("apparent, Newtonian rate 3.91 1/s", report::Mark::line_and_points),
                 curve("apparent, rate at the vane 10.2 1/s", report::Mark::line_and_points)},
      .levels = {{"truth", synthetic::alpha, 0.0}},
      .y_from_zero = true};
  for (std::size_t i = 0; i < 4; ++i) {
    out << "| " << a.window[i] << " s | " << median(a.newtonian[i]) << " | " << median(a.vane[i]) << " |\n";
    csv << a.window[i];
    for (std::size_t k = 0; k < 2; ++k) {
      const auto& v = k == 0 ? a.newtonian[i] : a.vane[i];
      report::Curve& drawn = chart.curves[k];
      add_point(drawn, a.window[i], median(v));
      drawn.low.push_back(quantile(v, 0.025)), drawn.high.push_back(quantile(v, 0.975));
      csv << ',' << drawn.y.back() << ',' << drawn.low.back() << ',' << drawn.high.back();
    }
    csv << '\n';
  }
  const double first = a.window.front(), last = a.window.back(), fitted = median(a.fitted);
  const double low = quantile(a.fitted, 0.025), high = quantile(a.fitted, 0.975);
  chart.curves.push_back({"fit of the whole record, with 95 %", {first, last}, {fitted, fitted}});
  chart.bands = {{"", {first, last}, {low, low}, {high, high}}};
  std::ofstream(directory + "/fit_apparent_alpha.svg") << report::svg_file({chart});
}

std::string text(const std::optional<ParameterEstimate>& e) {
  if (!e) return "null";
  std::ostringstream s;
  s << std::setprecision(3) << e->value;
  if (e->given) return s.str() + " (given)";
  if (e->ci95) s << " [" << e->ci95->low << ", " << e->ci95->high << "]";
  return s.str();
}

void write_site(std::ofstream& out, const std::string& file) {
  const TorqueRecord record = read_torque_record(file);
  const double rate = 12.43;
  const Instrument icar;
  const double ratio = icar.vane_radius / icar.container_radius;
  out << "\n## The paper's site test\n\nTorque 2 -> 1.25 N m in about 10 s, exponent 0.43 1/s, shear rate "
         "12.43 1/s; the record "
         "is rebuilt\n(reference_data/site_torque/rebuilt.csv).\n\n"
         "The paper's way: 0.43/12.43 = "
      << std::setprecision(3) << 0.43 / rate
      << " (it prints 0.0358). This assumes 12.43 1/s in all sheared material, throughout the record.\n\nThe "
         "full "
         "fit needs what the paper does not print: the vane's speed and two material parameters. Each row "
         "states "
         "its own.\n\n"
         "| assumption | alpha | lambda_0 | tau_0 Pa | mu Pa s | sheared as far as | alpha the paper's way "
         "from the same fit, Newtonian rate / rate at the vane |\n"
         "|---|---|---|---|---|---|---|\n";
  const auto row = [&](const std::string& assumption, double speed, std::optional<double> tau_0,
                       std::optional<double> mu) {
    FitInput input;
    input.omega = speed;
    input.tau_0 = tau_0;
    input.mu = mu;
    const FitResult f = fit(record, input);
    out << "| " << assumption << " | " << text(f.alpha) << " | " << text(f.lambda_0) << " | " << text(f.tau_0)
        << " | " << text(f.mu) << " | " << 1e3 * *f.sheared_radius << " mm | ";
    if (f.apparent) out << f.apparent->windows.back().alpha_newtonian_rate;
    if (f.apparent && f.apparent->rate_at_vane)
      out << " / " << *f.apparent->windows.back().alpha_rate_at_vane << " (" << *f.apparent->rate_at_vane
          << " 1/s)";
    out << " |\n";
  };
  const double newtonian = 0.5 * rate * (1.0 - ratio * ratio);
  row("12.43 1/s is the Newtonian rate: 0.794 rev/s; yield stress of Mix A", newtonian, 54.0, {});
  row("12.43 1/s is the Newtonian rate; yield stress 100 Pa", newtonian, 100.0, {});
  row("0.5 rev/s; viscosity of Mix A", angular_speed(0.5), {}, 35.8);
  row("0.25 rev/s; viscosity of Mix A", angular_speed(0.25), {}, 35.8);
  row("0.25 rev/s; yield stress of Mix A", angular_speed(0.25), 54.0, {});
}

void run(const std::string& directory, const std::string& site) {
  std::ofstream out(directory + "/fit_study.md");
  out << "# What a fit of a torque record is worth\n\n"
      << made_by("study_fit") << "\n\n"
      << "Mix A (54 Pa, 35.8 Pa s; 1.3 Pa/s, 240 s of rest, alpha 0.0358, gated), ICAR geometry, decay at "
         "0.25 rev/s; "
      << seeds << " records each, 2 % noise.\nCoverage of the 95 % intervals:\n\n"
      << "| record | parameter | truth | median | inside the interval | null |\n|---|---|---|---|---|---|\n";
  for (const int readings : {7, 20, 200})
    write_coverage(out, ("flow curve, " + std::to_string(readings) + " readings").c_str(),
                   flow_curve_coverage(readings, noise, seeds));
  Apparent apparent;
  write_coverage(out, "decay, yield stress and viscosity given",
                 decay_coverage(true, noise, seeds, [&](const FitResult& f) { apparent.add(f); }));
  write_coverage(out, "decay, viscosity given", decay_coverage(false, noise, seeds));
  write_apparent(out, apparent, directory);
  write_site(out, site);
}

}  // namespace
}  // namespace tremie::study

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: fit_study DIR SITE.csv\n";
    return 2;
  }
  tremie::study::run(argv[1], argv[2]);
}
