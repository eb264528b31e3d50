// The rheometer, and estimates from a slump flow, on plain values in SI units.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/estimate/estimate.hpp"
#include "apparatus/python/core/arrays.hpp"
#include "apparatus/python/core/parts.hpp"
#include "apparatus/report/fit_results.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie::python {
namespace {

using Numbers = std::vector<double>;
using Optional = std::optional<double>;

/// Calls, and makes what a caller can mend of std::invalid_argument. Without Python's lock.
template <class Call>
auto unlocked(Call call) {
  const py::gil_scoped_release release;
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(error.what());
  }
}

double quantity(const std::string& name, const std::string& text, const std::string& si_unit) {
  try {
    return scene::parse_quantity(text, scene::dimension_of(si_unit));
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(fmt::format("{}: {}", name, error.what()));
  }
}

Kinetics kinetics_of(const std::string& name) {
  if (const auto kinetics = kinetics_named(name)) return *kinetics;
  throw scene::InputError(fmt::format("kinetics: \"{}\" is not allowed; allowed: \"{}\"", name,
                                      fmt::join(kinetics_words(), "\", \"")));
}

FlowLaw law_named(const std::string& name) {
  if (name == "bingham") return FlowLaw::bingham;
  if (name == "herschel_bulkley") return FlowLaw::herschel_bulkley;
  if (name == "auto") return FlowLaw::automatic;
  throw scene::InputError(
      fmt::format("law: \"{}\" is not allowed; allowed: \"bingham\", \"herschel_bulkley\", \"auto\"", name));
}

FitInput input_of(const Instrument& instrument, Optional omega, Optional rest, Optional tau_0, Optional mu,
                  const std::string& kinetics, double gamma_c, const std::string& law,
                  Optional max_aggregate) {
  const bool choose = kinetics == "auto";
  return {.instrument = instrument,
          .tau_0 = tau_0,
          .mu = mu,
          .omega = omega,
          .rest = rest,
          .kinetics = choose ? Kinetics{} : kinetics_of(kinetics),
          .max_aggregate = max_aggregate.value_or(0.0),
          .choose_kinetics = choose,
          .law = law_named(law),
          .gamma_c = gamma_c};
}

TorqueRecord record_of(bool is_decay, const Numbers& x, const Numbers& torque) {
  TorqueRecord record;
  record.kind = is_decay ? RecordKind::torque_decay : RecordKind::flow_curve;
  (is_decay ? record.time : record.omega) = x;
  record.torque = torque;
  for (std::size_t i = 0; i < x.size(); ++i) record.line.push_back(static_cast<long>(i) + 1);
  return record;
}

#ifdef TREMIE_WITH_FITS
py::dict fit_record(const TorqueRecord& record, FitInput input) {
  if (!input.omega && record.speed > 0.0) input.omega = record.speed;
  FitResult result = unlocked([&] { return fit(record, input); });
  result.notes.push_back(taken_for_a_cylinder);
  result.notes.insert(result.notes.begin(), record.understood.begin(), record.understood.end());
  py::dict curve, d;
  const bool decay = result.kind == RecordKind::torque_decay;
  d["results"] = report::fit_results(result).dump();
  d["reasons"] = result.reasons;
  if (!decay)
    for (double& speed : result.curve.x) speed /= 2.0 * std::numbers::pi;
  curve[decay ? "time_s" : "speed_rev_per_s"] = array_of(std::move(result.curve.x));
  curve["torque_N_m"] = array_of(std::move(result.curve.observed));
  curve["torque_fit_N_m"] = array_of(std::move(result.curve.fitted));
  curve["torque_fit_error_N_m"] = array_of(std::move(result.curve.standard_error));
  if (decay) curve["flocculation_apparent"] = array_of(std::move(result.lambda_apparent));
  d["curve"] = curve;
  return d;
}
#else
py::dict fit_record(const TorqueRecord&, const FitInput&) {
  throw std::runtime_error(
      "fit: not in this build, which lacks libceres-dev, libboost-dev or libsundials-dev");
}
#endif

py::tuple torques(double tau_0, double mu, const Numbers& omega, const Instrument& instrument) {
  Numbers torque, radius;
  unlocked([&] {
    for (const double w : omega) {
      const CouetteState state = reiner_riwlin({tau_0, mu}, w, instrument);
      torque.push_back(state.torque), radius.push_back(state.sheared_radius);
    }
  });
  return py::make_tuple(array_of(std::move(torque)), array_of(std::move(radius)));
}

py::array speeds(double tau_0, double mu, const Numbers& torque, const Instrument& instrument) {
  Numbers omega;
  unlocked([&] {
    for (const double T : torque) omega.push_back(reiner_riwlin_speed({tau_0, mu}, T, instrument));
  });
  return array_of(std::move(omega));
}

#ifdef TREMIE_WITH_SUNDIALS
py::array flocculation(const Numbers& times, const std::vector<std::array<double, 3>>& history,
                       const Thixotropy& thixotropy, double tau_0, double lambda_0) {
  return array_of(unlocked([&] {
    std::vector<ShearSegment> segments;
    for (const auto& [duration, from, to] : history) segments.push_back({duration, from, to});
    return flocculation_ode(linear_pieces(segments), thixotropy, tau_0, lambda_0, times).lambda;
  }));
}
#else
py::array flocculation(const Numbers&, const std::vector<std::array<double, 3>>&, const Thixotropy&, double,
                       double) {
  throw std::runtime_error("flocculation: not in this build, which lacks libsundials-dev");
}
#endif

py::object dict_of(const std::optional<estimate::Interval>& i) {
  using namespace py::literals;
  if (!i) return py::none();
  return py::dict("value"_a = i->value, "ci95"_a = py::make_tuple(i->low, i->high));
}

py::dict estimate_mix(const estimate::Measured& measured) {
  using namespace py::literals;
  const auto e = unlocked(
      [&] { return estimate::estimate(estimate::find_slump_table(scene::data_folders()), measured); });
  return py::dict("yield_stress_Pa"_a = dict_of(e.tau_0), "plastic_viscosity_Pa_s"_a = dict_of(e.mu),
                  "yield_stress_thin_layer_law_Pa"_a = e.tau_0_thin_layer,
                  "yield_stress_with_plug_stress_Pa"_a = e.tau_0_plug, "reasons"_a = e.reasons);
}

}  // namespace

void add_rheometer(py::module_& module) {
  using namespace py::literals;
  py::class_<Instrument>(module, "Instrument")
      .def(py::init<double, double, double>(), "vane_radius"_a, "vane_height"_a, "container_radius"_a);
  py::class_<FitInput>(module, "FitInput")
      .def(py::init(&input_of), "instrument"_a, "omega"_a, "rest"_a, "tau_0"_a, "mu"_a, "kinetics"_a,
           "gamma_c"_a, "law"_a, "max_aggregate"_a);
  py::class_<Thixotropy>(module, "Thixotropy")
      .def(py::init([](double A_thix, double alpha, const std::string& kinetics, double gamma_c,
                       double exponent, Optional saturation) {
             Thixotropy t{A_thix, kinetics_of(kinetics)};
             const auto set = [&](const char* name, Optional value) {
               if (double* member = parameter(t.kinetics, name); member && value) *member = *value;
             };
             set("destructuration", alpha), set("critical_shear_rate", gamma_c);
             set("exponent", exponent), set("saturation", saturation);
             return t;
           }),
           "A_thix"_a, "alpha"_a, "kinetics"_a, "gamma_c"_a, "exponent"_a, "saturation"_a);
  py::class_<estimate::Measured>(module, "Measured")
      .def(py::init<double, double, Optional, double, double>(), "spread"_a, "spread_error"_a, "t500"_a,
           "t500_error"_a, "density"_a);
  module.def("quantity", &quantity, "name"_a, "text"_a, "si_unit"_a);
  module.def("fit", [](bool is_decay, const Numbers& x, const Numbers& torque, const FitInput& input) {
    return fit_record(record_of(is_decay, x, torque), input);
  });
  module.def("fit_file", [](const std::string& path, const FitInput& input) {
    return fit_record(read_torque_record(path), input);
  });
  module.def("torques", &torques, "tau_0"_a, "mu"_a, "omega"_a, "instrument"_a);
  module.def("speeds", &speeds, "tau_0"_a, "mu"_a, "torque"_a, "instrument"_a);
  module.def("flocculation", &flocculation);
  module.def("estimate", &estimate_mix);
}

}  // namespace tremie::python
