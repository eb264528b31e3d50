// Case 4: a Bingham film down a plane and plane Poiseuille flow.

#include "apparatus/verification/references/film.hpp"

#include <fmt/format.h>

#include "apparatus/verification/suite.hpp"
#include "libmpm/explicit/step.hpp"

namespace tremie::verification {
namespace {

using film::Flow;

template <class Law, class Profile>
Run profile_error(const Flow& flow, const Law& law, YieldMethod method, int cells, const Profile& profile) {
  const double start = cpu_seconds();
  bool converged = false;
  const auto samples = film::steady_state(flow, law, method, cells, converged);
  const double cpu = cpu_seconds() - start;
  return {fmt::format("{} cells", cells), film::height / cells, film::relative_error(samples, profile), cpu,
          converged ? "" : "not converged"};
}

template <class Law, class Profile>
Problem flow_problem(const std::string& name, const std::string& title, const Flow& flow, const Law& law,
                     const Profile& profile, double least_order, Depth depth) {
  Problem one{.name = name,
              .title = title,
              .equation = flow.film ? "a film 100 mm deep on a no-slip plane, τ = ρ g_x (H − y)"
                                    : "a channel 100 mm wide, τ = ρ g_x (H/2 − y)",
              .reference = "",
              .norm = "relative L2 error of the velocity profile",
              .series = {{"ADMM", {}}, {"primal-dual Newton", {}}}};
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

/// The steady profile by explicit steps from rest, at the points: 4 cells of 2 by 2 points along the flow, K
/// = 100 kPa. After 2.5 s (film) and 0.8 s (channel) less than 1e-4 of the start is left.
template <class Law, class Profile>
Run explicit_error(const Flow& flow, const Law& law, const ExplicitSettings& settings, ShapeFunctions shape,
                   int cells, const Profile& profile) {
  const double start = cpu_seconds(), h = film::height / cells;
  omp_set_num_threads(1);
  Body<PlaneStrain> body;
  body.mix.tau_0 = film::tau_0, body.mix.mu = film::mu, body.mix.K = 1e5, body.mix.density = film::rho;
  body.gravity = {flow.g_x(), flow.film ? -9.79 : 0.0};
  body.grid.axes[0] = {.h = h, .periodic = true, .n_cells = 4};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip};
  if (!flow.film) body.grid.axes[1].high = FaceKind::no_slip, body.grid.axes[1].n_cells = cells;
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {4 * h, film::height}, {8, 2 * cells}, film::rho, body.mix.K,
      [](const auto&) { return true; },
      [&](const auto& x) { return -film::rho * body.gravity[1] * (film::height - x[1]); }, body.points);
  auto state = start_explicit(body, law, settings, Shape<2>{shape, {0.25, 0.25}});
  bool failed = false;
  while (body.time < (flow.film ? 2.5 : 0.8)) failed |= explicit_step(body, law, settings, state).failed;
  write_back(state, body);
  std::vector<film::Sample> samples;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    samples.push_back({body.points.x[p][1], body.points.v[p][0], 0.0, body.points.volume(p)});
  return {fmt::format("{} cells", cells), h, film::relative_error(samples, profile), cpu_seconds() - start,
          failed ? "failed" : ""};
}

/// The paper's regularisation, m = 5 s, which explicit steps can carry, by every scheme. What the transfers
/// of explicit steps take from a curved profile is reported, without a bound.
Problem schemes(const Flow& flow, Depth depth) {
  constexpr double m = 5.0;
  const Papanastasiou law{m};
  const film::RegularisedProfile profile(flow, m);
  Problem one{.name = flow.film ? "film_schemes" : "poiseuille_schemes",
              .title = std::string(flow.film ? "Film" : "Plane Poiseuille flow") +
                       ", Papanastasiou m = 5 s, every scheme",
              .equation = flow.film ? "a film 100 mm deep on a no-slip plane, τ = ρ g_x (H − y)"
                                    : "a channel 100 mm wide, τ = ρ g_x (H/2 − y)",
              .reference = "τ(γ̇) = ρ g_x (…) solved for γ̇ and summed by Gauss' rule on 4000 intervals",
              .norm = "relative L2 error of the velocity profile"};
  struct Scheme {
    const char* name;
    ShapeFunctions shape;
    StressUpdate stress;
  };
  // An implicit step costs next to nothing here: finer cells than the explicit ones can pay for.
  std::vector<int> coarse = {4, 8, 16}, fine = {8, 16, 32};
  if (depth == Depth::full) coarse.push_back(32), fine.push_back(64);
  Series newton{"implicit, Newton", {}};
  for (int cells : fine) newton.runs.push_back(profile_error(flow, law, YieldMethod::newton, cells, profile));
  one.series.push_back(std::move(newton));
  for (const Scheme& scheme : {Scheme{"explicit USL, splines", ShapeFunctions::b_spline, StressUpdate::last},
                               {"explicit USL, GIMP", ShapeFunctions::gimp, StressUpdate::last},
                               {"explicit USF, splines", ShapeFunctions::b_spline, StressUpdate::first},
                               {"explicit USF, GIMP", ShapeFunctions::gimp, StressUpdate::first}}) {
    ExplicitSettings settings;
    settings.stress = scheme.stress;
    Series series{scheme.name, {}};
    for (int cells : coarse)
      series.runs.push_back(explicit_error(flow, law, settings, scheme.shape, cells, profile));
    one.series.push_back(std::move(series));
  }
  one.bounds = {{.what = "implicit: observed order",
                 .value = observed_order(one.series[0]),
                 .limit = 1.8,
                 .at_least = true}};
  return one;
}

}  // namespace

Case film_case(Depth depth) {
  Case result{4, "Film down a plane, plane Poiseuille flow", {}};
  for (const bool is_film : {true, false}) {
    const Flow flow{is_film};
    const std::string name = is_film ? "film" : "poiseuille",
                      title = is_film ? "Film" : "Plane Poiseuille flow";
    result.problems.push_back(flow_problem(
        name + "_exact", title + ", exact yield", flow, ExactBingham{},
        [&](double y) { return film::exact_velocity(flow, y); }, 1.5, depth));
    result.problems.back().reference = "closed form: a parabola up to the plug";
    result.problems.push_back(flow_problem(name + "_regularised", title + ", Papanastasiou m = 100 s", flow,
                                           Papanastasiou{100.0}, film::RegularisedProfile(flow, 100.0), 1.8,
                                           depth));
    result.problems.back().reference =
        "τ(γ̇) = ρ g_x (…) solved for γ̇ and summed by Gauss' rule on 4000 intervals";
    result.problems.push_back(schemes(flow, depth));
  }
  return result;
}

}  // namespace tremie::verification
