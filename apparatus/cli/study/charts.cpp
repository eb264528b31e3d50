#include "apparatus/cli/study/charts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apparatus/scene/units.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::cli {

namespace {

std::string head(const char* file, const char* x, const char* y) {
  return fmt::format(
      "reset\nset terminal svg size 720,440 dynamic background rgb 'white' font 'sans,14'\nset output '{}'\n"
      "set datafile separator ','\nset grid linecolor rgb '#dddddd'\nset border 3\nset tics nomirror out\n"
      "set xlabel '{}'\nset ylabel '{}'\nset offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05\n",
      file, x, y);
}

/// Few readings are drawn large.
std::string readings_style(const FitResult& r) {
  return fmt::format("linecolor rgb '#444444' pointtype 7 pointsize {}", r.curve.x.size() < 100 ? 0.8 : 0.3);
}

const char* const line = "with lines linewidth 2 linecolor rgb '#0b5394'";

std::string residual_chart(const FitResult& r, const char* x) {
  return head("residuals.svg", x, "residual in % of the fitted torque") +
         fmt::format(
             "unset key\nset xrange [0:*]\nplot 'fit.csv' every ::1 using 1:4 with points {}, 0 with lines "
             "linecolor rgb "
             "'#0b5394'\n",
             readings_style(r));
}

/// Stress over shear rate at the vane with the band of both parameters; only where both are told.
std::string flow_curve_chart(const FitResult& r, const Instrument& in) {
  if (!r.tau_0 || !r.mu || r.curve.x.empty()) return {};
  const auto rate_at_vane = [&](double torque) {
    return std::max(0.0, (shear_stress_at(in.vane_radius, torque, in) - r.tau_0->value) / r.mu->value);
  };
  std::string data = "$curve << EOD\n";
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    // 1.96: the band of the fitted torque, carried to the stress at the vane
    const double half = 1.96 * shear_stress_at(in.vane_radius, r.curve.standard_error[i], in);
    const double stress = shear_stress_at(in.vane_radius, r.curve.fitted[i], in);
    data += fmt::format("{},{},{},{},{}\n", rate_at_vane(r.curve.fitted[i]), stress, stress - half,
                        stress + half, shear_stress_at(in.vane_radius, r.curve.observed[i], in));
  }
  return head("flow_curve.svg", "shear rate at the vane in 1/s", "shear stress at the vane in Pa") + data +
         fmt::format(
             "EOD\nset key top left\nplot $curve using 1:3:4 with filledcurves linecolor rgb '#cfe2f3' title "
             "'95 % "
             "band', '' using 1:2 {} title 'Bingham, {:.4g} Pa, {:.4g} Pa.s', '' using 1:5 with points {} "
             "title "
             "'readings'\n",
             line, r.tau_0->value, r.mu->value, readings_style(r));
}

/// Speed and fitted torque at many speeds from just above 0 on, as a gnuplot block; the readings' own where a
/// parameter is not told.
std::string fitted_curve(const FitResult& r, const Instrument& in) {
  std::string data = "$fit << EOD\n";
  const auto add = [&](double omega, double torque) {
    data += fmt::format("{},{}\n", omega / two_pi, torque);
  };
  constexpr int pieces = 100;
  if (r.tau_0 && r.mu && r.mu->value > 0.0 && !r.curve.x.empty())
    for (int i = 0; i <= pieces; ++i) {
      const double omega = r.curve.x.back() * (i + 0.01) / pieces;
      add(omega, reiner_riwlin({r.tau_0->value, r.mu->value}, omega, in).torque);
    }
  else
    for (std::size_t i = 0; i < r.curve.x.size(); ++i) add(r.curve.x[i], r.curve.fitted[i]);
  return data + "EOD\n";
}

std::string torque_speed_chart(const FitResult& r, const Instrument& in) {
  std::string text = head("torque.svg", "speed in rev/s", "torque in N.m") + fitted_curve(r, in);
  text += "set key top left\nset xrange [0:*]\n";
  if (r.plug_below) {
    const double edge = *r.plug_below / two_pi;
    text += fmt::format(
        "set object 1 rectangle from graph 0, graph 0 to first {0:.6g}, graph 1 fillcolor rgb '#f3e9dc' "
        "fillstyle solid noborder behind\nset label 1 'plug below {0:.3g} rev/s' at graph 0.02, graph 0.06\n",
        edge);
  }
  return text + fmt::format(
                    "plot 'fit.csv' every ::1 using 1:2 with points {} title 'readings', $fit using 1:2 {} "
                    "title 'Reiner-Riwlin'\n",
                    readings_style(r), line);
}

std::string decay_charts(const FitResult& r) {
  std::string text =
      head("torque.svg", "time in s", "torque in N.m") + "set xrange [0:*]\n" +
      fmt::format(
          "plot 'fit.csv' every ::1 using 1:2 with points {} title 'readings', '' every ::1 using "
          "1:3 {} title 'thixotropic Couette model'\n",
          readings_style(r), line) +
      residual_chart(r, "time in s");
  if (!r.apparent || r.lambda_apparent.empty()) return text;
  const ApparentAlpha& all = r.apparent->windows.back();
  double log_sum = 0.0, n = 0.0;  // the exponential's factor: mean of ln(lambda) + c t
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    if (r.lambda_apparent[i] <= 0.0) continue;
    log_sum += std::log(r.lambda_apparent[i]) + all.coefficient * r.curve.x[i];
    n += 1.0;
  }
  return text + head("flocculation.svg", "time in s", "apparent lambda") + "set xrange [0:*]\n" +
         fmt::format(
             "plot 'fit.csv' every ::1 using 1:5 with points {} title 'from the torque', "
             "{:.6g}*exp(-{:.6g}*x) {} "
             "title 'exponential, {:.3g} 1/s'\n",
             readings_style(r), std::exp(log_sum / n), all.coefficient, line, all.coefficient);
}

}  // namespace

std::string fit_csv(const FitResult& r, const Instrument&) {
  const bool decay = r.kind == RecordKind::torque_decay;
  std::string text =
      decay ? "time_s,torque_N_m,torque_fit_N_m,residual_percent,flocculation_apparent\n"
            : "speed_rev_per_s,torque_N_m,torque_fit_N_m,residual_percent,torque_fit_error_N_m\n";
  const auto number = [](double v) { return std::isfinite(v) ? scene::write_number(v) : std::string{}; };
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    const double x = decay ? r.curve.x[i] : r.curve.x[i] / two_pi, fitted = r.curve.fitted[i];
    const double last =
        decay ? (i < r.lambda_apparent.size() ? r.lambda_apparent[i] : NAN) : r.curve.standard_error[i];
    text += number(x) + ',' + number(r.curve.observed[i]) + ',' + number(fitted) + ',' +
            number(100.0 * (r.curve.observed[i] / fitted - 1.0)) + ',' + number(last) + '\n';
  }
  return text;
}

std::string fit_charts(const FitResult& r, const Instrument& in) {
  if (r.kind == RecordKind::torque_decay) return decay_charts(r);
  return torque_speed_chart(r, in) + flow_curve_chart(r, in) + residual_chart(r, "speed in rev/s");
}

}  // namespace tremie::cli
