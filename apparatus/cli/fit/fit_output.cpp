#include "apparatus/cli/fit/fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "apparatus/scene/units.hpp"

namespace tremie::cli {

using scene::rounded;

void print_estimate(const char* name, const std::optional<Estimate>& e, const char* unit) {
  if (!e)
    fmt::print("{:<22} not told by this record\n", name);
  else if (e->given)
    fmt::print("{:<22} {} {} (given)\n", name, rounded(e->value, 4), unit);
  else if (!e->ci95)
    fmt::print("{:<22} {} {} (no interval: as many readings as parameters)\n", name, rounded(e->value, 4),
               unit);
  else
    fmt::print("{:<22} {} {} [{}, {}]\n", name, rounded(e->value, 4), unit, rounded(e->ci95->low, 4),
               rounded(e->ci95->high, 4));
}

namespace {

void print_estimate_if(const std::optional<Estimate>& e, const char* name, const char* unit) {
  if (e) print_estimate(name, e, unit);
}

void print_candidates(const FitResult& r) {
  if (r.candidates.size() > 1) {
    fmt::print("{:<22} {:>10} {:>9} {:>11} {:>8} {:>8}\n", "model", "parameters", "scatter", "correlation",
               "AICc", "fits");
    for (const Candidate& c : r.candidates)
      fmt::print("{:<22} {:>10} {:>7.2f} % {:>11.2f} {:>8} {:>8}\n", (c.chosen ? "* " : "  ") + c.name,
                 c.parameters, 100.0 * c.scatter, c.correlation,
                 c.difference ? fmt::format("+{:.1f}", *c.difference) : "-", c.fits ? "yes" : "no");
  }
  if (!r.choice.empty()) fmt::print("{:<22} {}\n", "chosen", r.choice);
}

}  // namespace

void print_result(const FitResult& r) {
  print_candidates(r);
  print_estimate("yield stress", r.tau_0, "Pa");
  if (r.model != "herschel_bulkley") print_estimate("plastic viscosity", r.mu, "Pa.s");
  print_estimate_if(r.consistency, "consistency", "Pa.s^n");
  print_estimate_if(r.flow_index, "flow index", "");
  if (r.kind == RecordKind::torque_decay) {
    print_estimate("static yield stress", r.static_yield_stress, "Pa");
    print_estimate("flocculation at start", r.lambda_0, "");
    print_estimate("alpha", r.alpha, "");
    print_estimate("A_thix", r.A_thix, "Pa/s");
    if (r.apparent) {
      const ApparentAlpha& all = r.apparent->windows.back();
      fmt::print(
          "{:<22} {:.4g} (exponential over {:.4g} s, shear rate 2 Omega/(1 - Ri^2/Ro^2) = {:.4g} 1/s)\n",
          "apparent alpha", all.alpha_newtonian_rate, all.window, r.apparent->newtonian_rate);
    }
  }
  print_estimate_if(r.exponent, "exponent n", "");
  if (r.plug) fmt::print("{:<22} {}\n", "plug", *r.plug ? "yes" : "no");
  fmt::print("{:<22} {} used, {} dropped, scatter {:.2g} %\n", "readings", r.readings, r.dropped_count,
             100.0 * r.scatter);
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, r.dropped.size()); ++i)
    fmt::print("{:<22} line {}: {}\n", "dropped", r.dropped[i].line, r.dropped[i].reason);
  if (r.dropped.size() > most) fmt::print("{:<22} and more, named in summary.json\n", "dropped");
  for (const auto& note : r.notes) fmt::print("{:<22} {}\n", "note", note);
}

}  // namespace tremie::cli
