#pragma once

// Material parameters, each with its 95 % interval, from a torque record.
//
// Flow curve: (tau_0, mu) by Reiner-Riwlin, the plug solved for at every speed. Torque decay at constant
// speed: (lambda_0, alpha), and tau_0 and mu where they are not given, by the thixotropic Couette model, so
// that the localisation of shear is accounted for. Beside it the paper's reading of the same record, the
// apparent alpha: the coefficient of an exponential through lambda(t) from equation (6), divided by a nominal
// shear rate, equation (5).
//
// The error of a reading is taken to be in proportion to it; outliers are named and left out
// (least_squares.hpp).

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"
#include "rheometer/records/torque_record.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie {

/// A law of a flow curve (flow_law.hpp) with all of its parameters.
struct KnownLaw {
  std::string name;
  std::vector<double> parameters;
  std::vector<double> covariance;  ///< row by row; empty: not known
};

/// What is known besides the record.
struct FitInput {
  Instrument instrument;
  std::optional<double> tau_0;   ///< dynamic yield stress [Pa]
  std::optional<double> mu;      ///< plastic viscosity [Pa s]
  std::optional<double> omega;   ///< speed of a torque decay [rad/s]; a decay needs it
  std::optional<double> rest;    ///< rest before a torque decay [s]
  Kinetics kinetics = {};        ///< of a decay; their parameters are what the fit finds, and gamma_c
  double max_aggregate = 0.0;    ///< largest grain [m]; 0: not known
  bool choose_kinetics = false;  ///< fit each kinetics and take the one that the record supports best
  std::string law =
      "bingham";           ///< of a flow curve (flow_law.hpp); "auto": the one that the record supports best
  bool law_given = false;  ///< the user's: a section of a record takes it as well
  std::optional<KnownLaw> curve;  ///< of a decay: its material's flow curve, in place of tau_0 and mu
  double gamma_c = 0.1;           ///< critical shear rate of the gate [1/s]
};

struct Interval {
  double low = 0.0, high = 0.0;
};

struct ParameterEstimate {
  double value = 0.0;
  std::optional<Interval> ci95;  ///< empty where as many readings as parameters leave no scatter to judge by
  bool given = false;            ///< taken from FitInput, not from the record
};

struct DroppedPoint {
  long line = 0;                 ///< of the file
  double x = 0.0, torque = 0.0;  ///< speed [rad/s] or time [s]; [N m]
  std::string reason;
};

/// One reading of alpha the paper's way. `coefficient` [1/s] is the exponent's, alpha =
/// coefficient/shear_rate.
struct ApparentAlpha {
  double window = 0.0;  ///< of the record, from its start [s]
  double coefficient = 0.0;
  double alpha_newtonian_rate = 0.0;         ///< shear rate 2 Omega/(1 - R_i^2/R_o^2)
  std::optional<double> alpha_rate_at_vane;  ///< shear rate at the vane at the start, by the fitted model
};

struct ApparentReading {
  double offset_torque = 0.0;          ///< the torque taken for lambda = 0 [N m]
  std::string offset;                  ///< where it comes from
  double newtonian_rate = 0.0;         ///< [1/s]
  std::optional<double> rate_at_vane;  ///< [1/s]
  std::vector<ApparentAlpha> windows;  ///< 2, 5, 10, 20 s as far as the record goes, and all of it (last)
};

/// A curve to plot: the readings used, condensed where there are very many.
struct FittedCurve {
  std::vector<double> x, observed, fitted;  ///< speed [rad/s] or time [s]; torque [N m]
  std::vector<double> standard_error;       ///< of the fitted torque [N m]
};

/// One of the models that were compared.
struct Candidate {
  std::string name;
  int parameters = 0;
  double scatter = 0.0, correlation = 0.0;  ///< of its residuals
  std::optional<double> aicc, difference;   ///< corrected Akaike criterion; difference to the smallest
  bool fits = false, chosen = false;
};

struct FitResult {
  RecordKind kind = RecordKind::flow_curve;
  std::string model;                          ///< kinetics or law: "power", "bingham"
  std::optional<ParameterEstimate> exponent;  ///< n of the power kinetics
  /// k gamma_dot^a of the rate_power kinetics at the record's shear rates, in place of alpha [1/s]
  std::optional<ParameterEstimate> breakdown_rate;
  /// Parameters that the law of a flow curve alone has, by their names: "consistency".
  std::map<std::string, std::optional<ParameterEstimate>> of_law;
  /// Of all parameters of a flow curve's law, row by row, so large that 1.96 standard deviations are their 95 %.
  std::vector<double> law_covariance;
  std::vector<Candidate> candidates;
  std::string choice;               ///< which model and why
  double effective_readings = 0.0;  ///< independent readings that carry as much as those used
  std::optional<ParameterEstimate> tau_0, mu, static_yield_stress, lambda_0, alpha, A_thix;
  std::optional<ApparentReading> apparent;
  std::optional<bool> plug;              ///< part of the gap is at rest at some reading
  std::optional<double> plug_below;      ///< speed below which there is a plug [rad/s], flow curve alone
  std::optional<double> sheared_radius;  ///< the smallest sheared radius over the record [m]
  std::vector<DroppedPoint> dropped;     ///< the first 100
  long dropped_count = 0;
  std::vector<std::pair<std::string, long>>
      dropped_reasons;               ///< each with its number, in order of appearance
  long readings = 0;                 ///< used
  double scatter = 0.0;              ///< relative standard deviation of a reading about the fit
  double correlation = 0.0;          ///< of successive residuals
  bool sheared_evenly = false;       ///< speeds and torques are those of evenly_sheared() (instrument.hpp)
  bool law_in_doubt = false;         ///< another law describes the readings far better: a note tells which
  std::vector<std::string> notes;    ///< assumptions, and why a value is missing
  std::vector<std::string> reasons;  ///< why the result is not to be trusted
  FittedCurve curve;
  std::vector<double> lambda_apparent;  ///< of curve.observed, torque decay alone
};

/// How speeds and torques of a record are shown: as they are, or as the shear rates and stresses that they stand for.
struct ShownUnits {
  double speed = 0.0;  ///< a speed over this is in the unit of its key
  const char *speed_key = "", *torque_key = "", *speed_unit = "", *speed_label = "", *torque_label = "";
};
inline ShownUnits shown_units(bool sheared_evenly) {
  if (sheared_evenly)
    return {evenly_sheared_speed, "shear_rate_per_s", "shear_stress_Pa", "1/s",
            "shear rate (1/s)",   "shear stress (Pa)"};
  return {angular_speed(1.0), "speed_rev_per_s", "torque_N_m", "rev/s", "speed (rev/s)", "torque (N·m)"};
}

/// The note of a fit without corrections for the vane's ends and blades.
inline constexpr const char* taken_for_a_cylinder =
    "the vane is treated as a cylinder without ends, which overestimates the yield stress by some 17 %; "
    "tremie fit --ends computed --blades computed corrects both";

/// Fits the record by its kind. Throws std::invalid_argument, with what is needed, for a record or an input
/// that cannot be fitted: too few rows, one speed only, a decay without a speed.
FitResult fit(const TorqueRecord& record, const FitInput& input);

}  // namespace tremie
