// The functions of the laws with a Newtonian viscous part agree with each other and with their own definitions
// (Herschel-Bulkley: test_herschel_bulkley.cpp).

#include <gtest/gtest.h>

#include <cmath>

#include "libmpm/constitutive/laws/yield_law.hpp"

namespace tremie {
namespace {

/// Stress magnitude of the yield part in extended precision, straight from the definitions.
long double carried(const ExactBingham& law, long double g, long double tau) {
  return tau * g / std::sqrt(g * g + static_cast<long double>(law.epsilon) * law.epsilon);
}
long double carried(const Papanastasiou& law, long double g, long double tau) {
  return -tau * std::expm1(-law.m * g);
}
long double carried(const BiViscous& law, long double g, long double tau) {
  return tau * std::min(g / static_cast<long double>(law.gamma_c), 1.0L);
}

/// ds/dgamma / gamma from a fourth-order difference in extended precision: relative error below 1e-12.
template <class Law>
double slope_by_difference(const Law& law, double rate, double tau) {
  const long double g = rate, h = 1e-3L * g;
  const auto s = [&](long double x) { return carried(law, x, tau) / x; };
  const long double d =
      (45.0L * (s(g + h) - s(g - h)) - 9.0L * (s(g + 2 * h) - s(g - 2 * h)) + (s(g + 3 * h) - s(g - 3 * h))) /
      (60.0L * h);
  return static_cast<double>(d / g);
}

/// int f from low to high by composite Gauss quadrature, for f smooth there.
template <class Law>
long double integral(const Law& law, long double low, long double high, long double tau) {
  constexpr int n = 400;
  constexpr long double place = 0.77459666924148337704L;
  const long double half = (high - low) / (2 * n);
  long double sum = 0.0L;
  for (int i = 0; i < n; ++i) {
    const long double middle = low + (2 * i + 1) * half;
    sum += half / 9.0L *
           (5.0L * carried(law, middle - place * half, tau) + 8.0L * carried(law, middle, tau) +
            5.0L * carried(law, middle + place * half, tau));
  }
  return sum;
}

/// int_0^rate f, in pieces that shrink towards 0 and end at the laws' own scale (the bi-viscous law has a
/// corner there).
template <class Law>
double potential_by_quadrature(const Law& law, double scale, double rate, double tau) {
  long double sum = 0.0L, high = rate;
  if (rate > scale) {
    for (; high > 2.0L * scale; high *= 0.5L) sum += integral(law, 0.5L * high, high, tau);
    sum += integral(law, scale, high, tau);
    high = scale;
  }
  for (; high > 1e-14L * static_cast<long double>(rate); high *= 0.5L)
    sum += integral(law, 0.5L * high, high, tau);
  return static_cast<double>(sum);
}

double scale_of(const ExactBingham& law) { return law.epsilon; }
double scale_of(const Papanastasiou& law) { return 1.0 / law.m; }
double scale_of(const BiViscous& law) { return law.gamma_c; }

template <class Law>
class YieldLaw : public testing::Test {
 protected:
  static Law make() { return Law{}; }
};
using Laws = testing::Types<ExactBingham, Papanastasiou, BiViscous>;
TYPED_TEST_SUITE(YieldLaw, Laws);

// 1e-9: the library switches to a series near zero whose remainder is below 1e-10 of the value.
TYPED_TEST(YieldLaw, SlopeIsTheDerivativeOfTheSecant) {
  const TypeParam law;
  for (double rate = 2e-7; rate < 1e4; rate *= 3.7) {
    const double expected = slope_by_difference(law, rate, 54.0);
    // The bi-viscous law has no other derivative than 0 below its corner; the difference sees round-off
    // there.
    EXPECT_NEAR(law.slope(rate, 54.0), expected,
                1e-9 * std::abs(expected) + 1e-13 * law.secant(rate, 54.0) / (rate * rate))
        << rate;
  }
}

// Where the rate is tiny the potential is a difference of nearly equal numbers; 1e-9 still holds there.
TYPED_TEST(YieldLaw, PotentialIsTheIntegralOfTheStress) {
  const TypeParam law;
  for (double rate = 1e-5; rate < 1e3; rate *= 7.3) {
    const double expected = potential_by_quadrature(law, scale_of(law), rate, 54.0);
    EXPECT_NEAR(law.potential(rate, 54.0) / expected, 1.0, 1e-9) << rate;
  }
  EXPECT_EQ(law.potential(0.0, 54.0), 0.0);
}

/// f(d) + r d = a over twelve decades of a; 1e-12 a is round-off, times m d where the exponential is steep.
template <class Law>
void expect_prox_consistent(const Law& law) {
  for (double tau : {0.0, 1e-3, 54.0, 5000.0})
    for (double r : {1e-2, 3.0, 107.4, 1e4})
      for (double a = 1e-6; a < 2e6; a *= 3.1) {
        const double d = law.prox(a, tau, r);
        ASSERT_GE(d, 0.0);
        ASSERT_TRUE(std::isfinite(d));
        const auto f = static_cast<double>(carried(law, d, tau));
        EXPECT_NEAR(f + r * d, a, 1e-12 * a * 60.0) << "a " << a << " tau " << tau << " r " << r;
      }
  EXPECT_EQ(law.prox(0.0, 54.0, 3.0), 0.0);
}

TEST(Prox, Papanastasiou) {
  for (double m : {0.1, 5.0, 100.0, 1e4, 1e6}) expect_prox_consistent(Papanastasiou{m});
}

TEST(Prox, PapanastasiouAtTheYieldStress) {
  // Just below tau_y the root runs away like a logarithm: the slowest case for a search from the left.
  const Papanastasiou law{1e6};
  for (double below : {1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
    const double a = 54.0 * (1.0 - below), d = law.prox(a, 54.0, 1e-6);
    EXPECT_NEAR(static_cast<double>(carried(law, d, 54.0)) + 1e-6 * d, a, 1e-11 * a);
  }
}

TEST(Prox, BiViscous) {
  for (double gamma_c : {1e-6, 1e-2, 1.0}) expect_prox_consistent(BiViscous{gamma_c});
}

// The exact law is set-valued at rest: d = 0 takes every a up to tau_y, beyond it tau_y + r d = a.
TEST(Prox, ExactBingham) {
  const ExactBingham law;
  for (double r : {1e-2, 107.4, 1e4})
    for (double a = 1e-6; a < 2e6; a *= 3.1) {
      const double d = law.prox(a, 54.0, r);
      if (a <= 54.0) {
        EXPECT_EQ(d, 0.0);
      } else {
        EXPECT_NEAR(54.0 + r * d, a, 1e-13 * a);
      }
    }
}

}  // namespace
}  // namespace tremie
