#pragma once

// Reiner-Riwlin: a Bingham material between a rotating cylinder R_i and a container R_o of height h.
//
// Where the stress T/(2 pi r^2 h) falls below tau_0 before the container, the material beyond
// R_s = sqrt(T/(2 pi h tau_0)) is a plug. With R_s = R_o where there is none,
//
//   mu Omega = T/(4 pi h) (1/R_i^2 - 1/R_s^2) - tau_0 ln(R_s/R_i).
//
// Source: Reiner and Riwlin (1927) as in Wallevik et al. (2015) and Feys et al. (2018), which the paper uses.
// Units: Omega [rad/s], torque [N m], tau_0 [Pa], mu [Pa s].

#include <span>

#include "rheometer/reference/instrument.hpp"

namespace tremie {

/// The two Bingham parameters, equation (1).
struct Bingham {
  double tau_0 = 0.0;  ///< dynamic yield stress [Pa]
  double mu = 0.0;     ///< plastic viscosity [Pa s]
};

struct CouetteState {
  double torque = 0.0;          ///< [N m]
  double sheared_radius = 0.0;  ///< R_s [m]; R_o where all is sheared
  bool plug = false;            ///< material beyond sheared_radius is at rest relative to the container
  double d_torque_d_tau_0 = 0.0, d_torque_d_mu = 0.0;
};

/// Torque at the speed omega >= 0. tau_0 = 0 is the Newtonian limit; mu = 0, or omega = 0 with tau_0 > 0, is
/// the limit of a layer sheared at the vane alone, T = 2 pi h R_i^2 tau_0. Throws std::invalid_argument for a
/// negative or non-finite parameter.
CouetteState reiner_riwlin(const Bingham& bingham, double omega, const Instrument& instrument = {});

/// The speed [rad/s] that the torque drives; 0 where no material yields. Needs mu > 0.
double reiner_riwlin_speed(const Bingham& bingham, double torque, const Instrument& instrument = {});

struct FlowPoint {
  double omega = 0.0;   ///< [rad/s]
  double torque = 0.0;  ///< [N m]
};

/// (tau_0, mu) from a flow curve: the least squares in torque over tau_0 >= 0, mu >= 0, plug solved for at
/// every speed; exact for two points that a Bingham material can give. Throws std::invalid_argument for fewer
/// than two different speeds, a speed or torque that is not positive.
Bingham bingham_from_flow_curve(std::span<const FlowPoint> points, const Instrument& instrument = {});

}  // namespace tremie
