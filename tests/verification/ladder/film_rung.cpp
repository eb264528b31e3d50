// Rung 4: a Bingham film down a plane and plane Poiseuille flow.

#include <fmt/format.h>

#include "tests/verification/film.hpp"
#include "tests/verification/ladder/ladder.hpp"

namespace tremie::verification {
namespace {

using film::Flow;

template <class Law, class Profile>
Run profile_error(const Flow& flow, const Law& law, YieldMethod method, int cells, const Profile& profile) {
  const double start = cpu_seconds();
  bool converged = false;
  const auto places = film::steady_state(flow, law, method, cells, converged);
  const double cpu = cpu_seconds() - start;
  return {fmt::format("{} cells", cells), film::height / cells, film::relative_error(places, profile), cpu,
          converged ? "" : "not converged"};
}

template <class Law, class Profile>
Case flow_case(const std::string& name, const std::string& title, const Flow& flow, const Law& law,
               const Profile& profile, double least_order, Depth depth) {
  Case one{.name = name,
           .title = title,
           .equation = flow.film ? "a film 100 mm deep on a no-slip plane, τ = ρ g_x (H − y)"
                                 : "a channel 100 mm wide, τ = ρ g_x (H/2 − y)",
           .reference = "",
           .norm = "relative L2 error of the velocity profile",
           .series = {{"ADMM", {}}, {"primal-dual Newton", {}}},
           .bounds = {}};
  for (int cells : {8, 16, 32, 64}) {
    if (cells == 64 && depth == Depth::quick) break;
    one.series[0].runs.push_back(profile_error(flow, law, YieldMethod::admm, cells, profile));
    one.series[1].runs.push_back(profile_error(flow, law, YieldMethod::newton, cells, profile));
  }
  for (const Series& s : one.series) {
    one.bounds.push_back({.what = s.scheme + ": observed order",
                          .value = observed_order(s),
                          .limit = least_order,
                          .at_least = true});
    if (depth == Depth::full)
      one.bounds.push_back(
          {.what = s.scheme + ": error at the finest cells", .value = s.runs.back().error, .limit = 1e-3});
  }
  return one;
}

}  // namespace

Rung film_rung(Depth depth) {
  Rung rung{4, "Film down a plane, plane Poiseuille flow", {}};
  for (const bool is_film : {true, false}) {
    const Flow flow{is_film};
    const std::string name = is_film ? "film" : "poiseuille",
                      title = is_film ? "Film" : "Plane Poiseuille flow";
    rung.cases.push_back(flow_case(
        name + "_exact", title + ", exact yield", flow, ExactBingham{},
        [&](double y) { return film::exact_velocity(flow, y); }, 1.5, depth));
    rung.cases.back().reference = "closed form: a parabola up to the plug";
    rung.cases.push_back(flow_case(name + "_regularised", title + ", Papanastasiou m = 100 s", flow,
                                   Papanastasiou{100.0}, film::RegularisedProfile(flow, 100.0), 1.8, depth));
    rung.cases.back().reference = "τ(γ̇) = ρ g_x (…) solved for γ̇ and summed by Gauss' rule on 4000 intervals";
  }
  return rung;
}

}  // namespace tremie::verification
