#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libmpm/geometry/geometries.hpp"

namespace tremie {

/// Material points as a structure of arrays, SI units. What a material does not have is an empty array. Masses and volumes are
/// those of the geometry: of the whole ring (Axisymmetric), per metre of width (PlaneStrain) or of height (Couette, Polar).
template <int D>
struct Points {
  std::vector<Vec<D>> x;          ///< position [m]
  std::vector<Vec<D>> v;          ///< velocity [m/s]
  std::vector<Mat<D, D>> C;       ///< affine velocity, APIC [1/s]
  std::vector<double> mass;       ///< [kg]
  std::vector<double> V0;         ///< stress-free volume [m^3]
  std::vector<double> ln_J;       ///< ln(V / V0)
  std::vector<double> lambda;     ///< flocculation state [1]; empty without thixotropy
  std::vector<double> gamma_dot;  ///< shear rate of the last step [1/s]; empty where nothing needs it
  std::vector<std::vector<double>> lambda_parts;  ///< whose sum lambda is; none where it is one number
  std::vector<int> mix;                           ///< of Body::mixes; empty where all are of one

  std::size_t size() const { return x.size(); }
  bool thixotropic() const { return !lambda.empty(); }
  /// Numbers of the flocculation state that a point stores: its value, and its parts where it has any.
  std::size_t lambda_numbers() const { return thixotropic() ? 1 + lambda_parts.size() : 0; }
  double volume(std::size_t p) const { return V0[p] * std::exp(ln_J[p]); }
};

/// Bytes that one more point costs, with so many numbers of the flocculation state and, if any, its shear rate.
template <int D>
std::int64_t bytes_per_point(std::size_t lambda_numbers) {
  const std::size_t doubles = 2 * D + D * D + 3 + (lambda_numbers > 0 ? lambda_numbers + 1 : 0);
  return static_cast<std::int64_t>(doubles * sizeof(double));
}

/// Room for n points without thixotropy.
template <int D>
void reserve(Points<D>& points, std::size_t n) {
  points.x.reserve(n), points.v.reserve(n), points.C.reserve(n);
  for (std::vector<double>* array : {&points.mass, &points.V0, &points.ln_J}) array->reserve(n);
}

/// Gives back the spare capacity.
template <int D>
void shrink(Points<D>& points) {
  points.x.shrink_to_fit(), points.v.shrink_to_fit(), points.C.shrink_to_fit();
  for (std::vector<double>* array :
       {&points.mass, &points.V0, &points.ln_J, &points.lambda, &points.gamma_dot})
    array->shrink_to_fit();
  for (std::vector<double>& part : points.lambda_parts) part.shrink_to_fit();
}

/// Adds a point at rest: its mass [kg], stress-free volume [m^3] and ln(V/V0). lambda, gamma_dot, lambda_parts and mix are the
/// caller's to fill (experiment::rest in apparatus/run/body_readings.hpp fills the first three).
template <int D>
void add_point(Points<D>& points, const Vec<D>& x, double mass, double V0, double ln_J) {
  points.x.push_back(x);
  points.v.push_back(Vec<D>::Zero());
  points.C.push_back(Mat<D, D>::Zero());
  points.mass.push_back(mass);
  points.V0.push_back(V0);
  points.ln_J.push_back(ln_J);
}

}  // namespace tremie
