// The rheometer, and estimates from a slump flow, on plain values in SI units.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/estimate/estimate.hpp"
#include "apparatus/python/core/arrays.hpp"
#include "apparatus/python/core/parts.hpp"
#include "apparatus/report/fit_input.hpp"
#include "apparatus/report/fit_results.hpp"
#include "apparatus/report/protocol_results.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "rheometer/reference/flocculation_ode.hpp"
#include "rheometer/reference/kinetics_equations.hpp"
#include "rheometer/whole_fit/fit_record.hpp"

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

/// Parameters that the chosen kinetics have no use for are judged as well.
Thixotropy thixotropy_of(double A_thix, double alpha, const std::string& name, double gamma_c,
                         double exponent, Optional saturation) {
  Thixotropy t{A_thix, kinetics_of(name)};
  for_each_kinetics([&](Kinetics kinetics) {
    const auto set = [&](const char* key, Optional value) {
      if (double* member = parameter(kinetics, key); member && value) *member = *value;
    };
    set("destructuration", alpha), set("critical_shear_rate", gamma_c);
    set("exponent", exponent), set("saturation", saturation);
    unlocked([&] { kinetics_equations::check({0.0, kinetics}, 0.0); });
    if (word(kinetics) == name) t.kinetics = kinetics;
  });
  return t;
}

/// The option from a number [SI], from text with a unit, a word or a flag, as Python has it.
void set_from(const py::handle& value, const FitOption& option, FitOptions& options) {
  try {
    if (py::isinstance<py::bool_>(value))
      set_option(options, option, value.cast<bool>());
    else if (py::isinstance<py::str>(value))
      report::read_option(options, option, option.name, value.cast<std::string>());
    else
      set_option(options, option, value.cast<double>());
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(fmt::format("{}: {}", option.name, error.what()));
  } catch (const py::cast_error&) {
    throw scene::InputError(
        fmt::format("{}: {} is no number, text or flag", option.name, py::repr(value).cast<std::string>()));
  }
}

FitOptions options_from(const py::dict& values) {
  FitOptions options;
  for (const FitOption& option : fit_options())
    if (values.contains(option.name) && !values[option.name.c_str()].is_none())
      set_from(values[option.name.c_str()], option, options);
  return options;
}

/// The table of options: what each is called and may be.
py::list option_rows() {
  using namespace py::literals;
  py::list rows;
  for (const FitOption& o : fit_options())
    rows.append(py::dict("name"_a = o.name, "unit"_a = o.unit, "words"_a = o.words, "help"_a = o.help,
                         "flag"_a = o.is_flag()));
  return rows;
}

RecordSource record_of(bool is_decay, const Numbers& x, const Numbers& torque) {
  TorqueRecord record;
  record.kind = is_decay ? RecordKind::torque_decay : RecordKind::flow_curve;
  (is_decay ? record.time : record.omega) = x;
  record.torque = torque;
  for (std::size_t i = 0; i < x.size(); ++i) record.line.push_back(static_cast<long>(i) + 1);
  return {.name = "", .record = record};
}

#ifdef TREMIE_WITH_FITS
py::dict curve_of(FitResult& fit) {
  py::dict curve;
  const bool decay = fit.kind == RecordKind::torque_decay;
  const ShownUnits shown = shown_units(fit.sheared_evenly);
  const std::string torque = fit.sheared_evenly ? "shear_stress" : "torque",
                    unit = fit.sheared_evenly ? "_Pa" : "_N_m";
  if (!decay)
    for (double& speed : fit.curve.x) speed /= shown.speed;
  curve[decay ? "time_s" : shown.speed_key] = array_of(std::move(fit.curve.x));
  curve[shown.torque_key] = array_of(std::move(fit.curve.observed));
  curve[(torque + "_fit" + unit).c_str()] = array_of(std::move(fit.curve.fitted));
  curve[(torque + "_fit_error" + unit).c_str()] = array_of(std::move(fit.curve.standard_error));
  if (decay) curve["flocculation_apparent"] = array_of(std::move(fit.lambda_apparent));
  return curve;
}

/// Takes the curves out of the fits.
py::dict fit_sources(const std::vector<RecordSource>& sources, const py::dict& values) {
  const FitOptions options = options_from(values);
  RecordFits fits = unlocked([&] { return fit_records(sources, options, scene::data_folders()); });
  std::vector<std::string> names;
  for (const RecordSource& source : sources) names.push_back(source.name);
  py::dict d;
  py::list curves;
  d["results"] = report::fit_results(fits, names).dump();
  d["reasons"] = fits.reasons;
  py::list sections;
  for (const ProtocolFit& protocol : fits.protocols) sections.append(report::protocol_csv(protocol.reading));
  d["sections"] = sections;
  for (FitResult& fit : fits.fits) curves.append(curve_of(fit));
  d["curves"] = curves;
  return d;
}
#else
py::dict fit_sources(const std::vector<RecordSource>&, const py::dict& values) {
  options_from(values);
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

/// The same refusals as the command's.
py::dict estimate_mix(const estimate::Measured& measured, const std::string& cone) {
  using namespace py::literals;
  const auto table = estimate::find_slump_table(scene::data_folders(), cone);
  estimate::check_readings(measured, table.mould);
  const auto e = unlocked([&] { return estimate::estimate(table, measured); });
  return py::dict("yield_stress_Pa"_a = dict_of(e.tau_0), "plastic_viscosity_Pa_s"_a = dict_of(e.mu),
                  "yield_stress_thin_layer_law_Pa"_a = e.tau_0_thin_layer,
                  "yield_stress_with_plug_stress_Pa"_a = e.tau_0_plug, "reasons"_a = e.reasons);
}

}  // namespace

void add_rheometer(py::module_& module) {
  using namespace py::literals;
  py::class_<Instrument>(module, "Instrument")
      .def(py::init<double, double, double>(), "vane_radius"_a, "vane_height"_a, "container_radius"_a);
  py::class_<Thixotropy>(module, "Thixotropy")
      .def(py::init(&thixotropy_of), "A_thix"_a, "alpha"_a, "kinetics"_a, "gamma_c"_a, "exponent"_a,
           "saturation"_a);
  py::class_<estimate::Measured>(module, "Measured")
      .def(py::init<Optional, double, Optional, double, Optional, double, Optional, double>(), "spread"_a,
           "spread_error"_a, "slump"_a, "slump_error"_a, "t500"_a, "t500_error"_a, "mu"_a, "density"_a);
  module.def("quantity", &quantity, "name"_a, "text"_a, "si_unit"_a);
  module.def("fit_options", &option_rows);
  module.def("fit", [](bool is_decay, const Numbers& x, const Numbers& torque, const py::dict& values) {
    return fit_sources({record_of(is_decay, x, torque)}, values);
  });
  module.def("fit_files", [](const std::vector<std::string>& paths, const py::dict& values) {
    std::vector<RecordSource> sources;
    for (const std::string& path : paths) sources.push_back({.name = path});
    return fit_sources(sources, values);
  });
  module.def("torques", &torques, "tau_0"_a, "mu"_a, "omega"_a, "instrument"_a);
  module.def("speeds", &speeds, "tau_0"_a, "mu"_a, "torque"_a, "instrument"_a);
  module.def("flocculation", &flocculation);
  module.def("estimate", &estimate_mix, "measured"_a, "cone"_a);
}

}  // namespace tremie::python
