#include "apparatus/cli/fit/fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apparatus/cli/fit/fit_protocol.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/scene/units.hpp"
#include "rheometer/fits/parameters.hpp"

namespace tremie::cli {

using scene::rounded;

void print_estimate(const std::string& name, const std::optional<ParameterEstimate>& e,
                    const std::string& unit) {
  if (!e)
    say("{:<22} not identifiable from this record\n", name);
  else if (e->given)
    say("{:<22} {} {} (given)\n", name, rounded(e->value, 4), unit);
  else if (!e->ci95)
    say("{:<22} {} {} (no interval: as many readings as parameters)\n", name, rounded(e->value, 4), unit);
  else
    say("{:<22} {} {} [{}, {}]\n", name, rounded(e->value, 4), unit, rounded(e->ci95->low, 4),
        rounded(e->ci95->high, 4));
}

std::string unit_on_screen(const FitParameter& parameter) {
  std::string unit = parameter.unit;
  std::replace(unit.begin(), unit.end(), ' ', '.');
  return unit;
}

namespace {

void print_candidates(const FitResult& r) {
  if (r.candidates.size() > 1) {
    say("{:<22} {:>10} {:>9} {:>11} {:>8} {:>8}\n", "model", "parameters", "scatter", "correlation", "AICc",
        "fits");
    for (const Candidate& c : r.candidates)
      say("{:<22} {:>10} {:>7.2f} % {:>11.2f} {:>8} {:>8}\n", (c.chosen ? "* " : "  ") + c.name, c.parameters,
          100.0 * c.scatter, c.correlation, c.difference ? fmt::format("{:+.1f}", *c.difference) : "-",
          c.fits ? "yes" : "no");
  }
  if (!r.choice.empty()) say("{:<22} {}\n", "chosen", r.choice);
}

void print_result(const FitResult& r) {
  print_candidates(r);
  for (const FitParameter& p : parameters_of(r))
    if (const auto e = value_of(r, p); e || p.member) print_estimate(p.label, e, unit_on_screen(p));
  if (r.apparent) {
    const ApparentAlpha& all = r.apparent->windows.back();
    say("{:<22} {:.4g} (exponential over {:.4g} s, shear rate 2 Omega/(1 - Ri^2/Ro^2) = {:.4g} 1/s)\n",
        "apparent alpha", all.alpha_newtonian_rate, all.window, r.apparent->newtonian_rate);
  }
  if (r.exponent) print_estimate("exponent n", r.exponent, "");
  if (r.plug) say("{:<22} {}\n", "plug", *r.plug ? "yes" : "no");
  say("{:<22} {} used, {} dropped, scatter {:.2g} %\n", "readings", r.readings, r.dropped_count,
      100.0 * r.scatter);
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, r.dropped.size()); ++i)
    say("{:<22} line {}: {}\n", "dropped", r.dropped[i].line, r.dropped[i].reason);
  if (r.dropped.size() > most) say("{:<22} and more, named in summary.json\n", "dropped");
  for (const auto& note : r.notes) say("{:<22} {}\n", "note", note);
}

std::string percent(const std::optional<double>& v) { return v ? fmt::format("{:.2g} %", 100.0 * *v) : "-"; }

void print_means(const RecordFits& fits) {
  std::size_t width = 22;
  for (const ReplicateMean& m : fits.means) width = std::max(width, m.parameter.name.size());
  say("--- mean of {} records\n{:<{}} {:>10} {:>24} {:>9} {:>9} {:>13}\n",
      std::max(fits.fits.size(), fits.protocols.size()), "", width, "mean", "95 %", "between", "within",
      "laboratories");
  std::string where;
  for (const ReplicateMean& m : fits.means) {
    if (m.where != where) say("{}\n", m.where);
    where = m.where;
    say("{:<{}} {:>10} {:>24} {:>9} {:>9} {:>13}\n", m.parameter.name, width, rounded(m.mean.value, 4),
        m.mean.ci95 ? fmt::format("[{}, {}] {}", rounded(m.mean.ci95->low, 4), rounded(m.mean.ci95->high, 4),
                                  m.parameter.unit)
                    : "-",
        percent(m.between), percent(m.within), percent(m.parameter.laboratories));
  }
  for (const auto& note : fits.notes) say("{:<22} {}\n", "note", note);
  say("between laboratories one cement paste scattered by 27 % in yield stress and 24 % in viscosity "
      "(Haist et al. 2020)\n");
}

void print_ends(const RecordFits& fits) {
  if (fits.options.ends == "none") return;
  say("{:<22} {}: torque {:.4g} times that of the side", "ends", fits.options.ends, fits.end_factor);
  for (const MoveByEnds& m : fits.moves) say("; {} {:+.1f} %", m.key, 100.0 * m.change);
  say("\n");
}

}  // namespace

void print_fits(const RecordFits& fits, const std::vector<std::string>& records) {
  if (!fits.protocols.empty()) {
    const bool several = fits.protocols.size() > 1;
    for (std::size_t i = 0; i < fits.protocols.size(); ++i) {
      if (several) say("--- {}\n", records[i]);
      print_protocol(fits.protocols[i].reading);
      if (!several) print_ends(fits);
      for (const auto& note : fits.protocols[i].record.understood) say("{:<22} {}\n", "read", note);
    }
    if (several) print_means(fits), print_ends(fits);
  } else if (fits.fits.size() > 1) {
    for (std::size_t i = 0; i < fits.fits.size(); ++i) {
      say("--- {}\n", records[i]);
      print_result(fits.fits[i]);
    }
    print_means(fits);
  } else {
    print_result(fits.fits.front());
    print_ends(fits);
    if (const std::string walls = fits.options.tribometer ? scene_walls(fits.fits.front()) : "";
        !walls.empty())
      say("\n{}\n", walls);
  }
}

}  // namespace tremie::cli
