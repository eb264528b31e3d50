// Verification case 4: a Bingham film down an inclined plane and plane Poiseuille flow (apparatus/verification/references/film.hpp), at
// exact yield and with Papanastasiou's m = 100 s.

#include "apparatus/verification/references/film.hpp"

#include <gtest/gtest.h>

#include "apparatus/verification/case.hpp"

namespace tremie {
namespace {

using namespace verification;
using namespace verification::film;

/// Relative error against resolutions that double: the observed order.
double order_of(const std::vector<double>& errors) {
  Series series;
  for (std::size_t i = 0; i < errors.size(); ++i)
    series.runs.push_back({.label = "", .h = std::pow(0.5, static_cast<double>(i)), .error = errors[i]});
  return verification::observed_order(series);
}

template <class Law>
std::vector<Sample> steady(const Flow& flow, const Law& law, YieldMethod method, int cells) {
  bool converged = false;
  auto samples = steady_state(flow, law, method, cells, converged);
  EXPECT_TRUE(converged);
  return samples;
}

const std::vector<int> resolutions{8, 16, 32, 64};

class ExactYield : public testing::TestWithParam<bool> {};

// Order 1.5: the profile has a kink in its second derivative at the plug, inside a cell. The plug's edge is
// read where the shear rate falls to a thousandth of the wall's, and must lie within half a cell of H -
// tau_0/(rho g_x) from the surface. Both methods solve one problem: they agree a hundred times better than
// the coarsest error.
TEST_P(ExactYield, ProfilePlugAndOrder) {
  const Flow flow{GetParam()};
  std::vector<double> errors;
  for (int cells : resolutions) {
    const auto admm = steady(flow, ExactBingham{}, YieldMethod::admm, cells);
    const auto newton = steady(flow, ExactBingham{}, YieldMethod::newton, cells);
    errors.push_back(relative_error(admm, [&](double y) { return exact_velocity(flow, y); }));
    double edge = 0.0, apart = 0.0;
    const double wall_rate = (flow.shear_stress(0.0) - tau_0) / mu;
    for (std::size_t i = 0; i < admm.size(); ++i) {
      if (flow.mirrored(admm[i].y) == admm[i].y && std::abs(admm[i].gamma_dot) > 1e-3 * wall_rate)
        edge = std::max(edge, admm[i].y);
      apart = std::max(apart, std::abs(admm[i].v - newton.at(i).v));
    }
    apart /= exact_velocity(flow, flow.surface());
    std::printf(
        "%s exact, %2d cells: error %.3e, plug from %.5f (exact %.5f, cell %.5f), methods apart %.1e\n",
        flow.film ? "film" : "channel", cells, errors.back(), edge, flow.plug_from(), height / cells, apart);
    EXPECT_NEAR(edge, flow.plug_from(), 0.5 * height / cells);
    EXPECT_LE(apart, 1e-4);
  }
  const double order = order_of(errors);
  std::printf("%s exact: order %.2f\n", flow.film ? "film" : "channel", order);
  EXPECT_GE(order, 1.5);
  EXPECT_LE(errors.back(), 1e-3);
}

class Regularised : public testing::TestWithParam<bool> {};

TEST_P(Regularised, ProfileAndOrder) {
  const Flow flow{GetParam()};
  const RegularisedProfile profile(flow, 100.0);
  std::vector<double> errors;
  for (int cells : resolutions) {
    const auto newton = steady(flow, Papanastasiou{100.0}, YieldMethod::newton, cells);
    const auto admm = steady(flow, Papanastasiou{100.0}, YieldMethod::admm, cells);
    errors.push_back(relative_error(newton, profile));
    double apart = 0.0;
    for (std::size_t i = 0; i < admm.size(); ++i)
      apart = std::max(apart, std::abs(admm[i].v - newton.at(i).v));
    apart /= exact_velocity(flow, flow.surface());
    std::printf("%s m = 100, %2d cells: error %.3e, methods apart %.1e\n", flow.film ? "film" : "channel",
                cells, errors.back(), apart);
    EXPECT_LE(apart, 1e-4);
  }
  const double order = order_of(errors);
  std::printf("%s m = 100: order %.2f\n", flow.film ? "film" : "channel", order);
  EXPECT_GE(order, 1.8);
  EXPECT_LE(errors.back(), 1e-3);
}

const auto name = [](const auto& info) { return std::string(info.param ? "Film" : "Poiseuille"); };
INSTANTIATE_TEST_SUITE_P(Plane, ExactYield, testing::Bool(), name);
INSTANTIATE_TEST_SUITE_P(Plane, Regularised, testing::Bool(), name);

}  // namespace
}  // namespace tremie
