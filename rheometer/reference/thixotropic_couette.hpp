#pragma once

// A thixotropic Bingham or Herschel-Bulkley material between a rotating cylinder R_i and a container R_o, without inertia: a
// differential-algebraic system in r and t, integrated by SUNDIALS IDA.
//
//   mu gamma_dot^n + (1 + lambda) tau_0 = T/(2 pi r^2 h) where this yields, gamma_dot = 0 in the plug   equations (2), (6)
//   int gamma_dot/r dr = Omega(t)                                                                     no slip
//   d lambda/dt = A_thix/tau_0 - alpha lambda gamma_dot                                               equation (3),
//
// or any other kinetics of kinetics_equations.hpp; with modes lambda is the sum of parts, each with an equation of its own.
// Material moves in circles, so every radius keeps its own lambda. With thixotropy.layer, gamma_dot in the kinetics is its
// mean over that length (couette_layer.hpp). With a shear modulus G the material is elastic below its yield stress
// (Saramito, J. Non-Newtonian Fluid Mech. 145 (2007) 1, at small strains): the vane's speed is then that of the equations
// above and, in series, (1 - R_i^2/R_o^2) / (4 pi R_i^2 h G) dT/dt.
//
// Discretised on intervals of x = ln(r/R_i), equal ones for n = 1, else shorter at the vane, where a shear-thinning material
// shears in a thin layer; the constraint is int gamma_dot dx: lambda at the
// nodes, the excess stress linear between them, the shear rate of its positive part integrated exactly (the plug's edge
// lies inside an interval). Second order in x while lambda(r) is smooth. Under the gate, a node that passes
// gamma_c is found as a root. Units: SI; Omega [rad/s].

#include <functional>
#include <span>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie {

struct CouetteFlow {
  Bingham bingham;                              ///< tau_0 > 0, mu > 0
  Thixotropy thixotropy;                        ///< initial_flocculation is lambda everywhere at time 0
  double omega = 0.0;                           ///< constant speed of the vane [rad/s], > 0
  std::function<double(double)> omega_of_time;  ///< if set, takes the place of omega; smooth, > 0
  double flow_index = 1.0;                      ///< n, 0.2 to 2; bingham.mu is then the consistency [Pa s^n]
  double shear_modulus = 0.0;  ///< G below the yield stress, without stress at time 0 [Pa]; 0: rigid
};

struct CouetteOptions {
  int intervals = 400;
  double relative_tolerance = 1e-7;
  double absolute_tolerance = 1e-8;  ///< of lambda; of the vane's shear stress in Pa
  bool keep_profiles = false;
  /// false: the nodes are spent on the radii that can be sheared, with a margin; the far plug is left out.
  bool whole_gap = true;
  /// true: a node that passes the gate is found as a root, and the integration starts anew behind it. false:
  /// the error node steps over the kink.
  bool find_gate = true;
};

/// The gap (or the part of it that is resolved) at one time; one entry a node, from the vane outwards.
struct CouetteProfile {
  std::vector<double> lambda, gamma_dot;
};

struct CouetteDecay {
  std::vector<double> time;             ///< [s]
  std::vector<double> torque;           ///< [N m]
  std::vector<double> sheared_radius;   ///< outermost radius that is sheared [m]
  std::vector<double> radius;           ///< of the nodes [m]
  std::vector<CouetteProfile> profile;  ///< one a time, if asked for
  long steps = 0;
  long gate_crossings = 0;  ///< summed over the nodes
};

/// The torque at `times` [s], ascending, from 0 on.
/// Throws std::invalid_argument for parameters out of range, std::runtime_error where IDA gives up.
CouetteDecay thixotropic_couette(const CouetteFlow& flow, std::span<const double> times,
                                 const Instrument& instrument = {}, const CouetteOptions& options = {});

/// int [mu gamma_dot^2 + (1 + lambda) tau_0 gamma_dot] dV of a Bingham material's profile [W], which equals T Omega.
double dissipated_power(const CouetteProfile& profile, std::span<const double> radius, const Bingham& bingham,
                        const Instrument& instrument = {});

}  // namespace tremie
