#pragma once

// A random combination of what a scene may say, the same for the same number, and what physics expects of it.

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace tremie::test {

struct RandomScene {
  std::string apparatus, text;
  double tau_0 = 0.0, mu = 0.0, K = 0.0, lambda = 0.0, cell = 0.0, cell_up = 0.0;
  double speed = 0.0, duration = 0.0;  ///< of the vane [rev/s]; of the test [s]
  bool exact = true, herschel_bulkley = false, thixotropic = false, power_gated = false;
  std::string space, contact;
};

class SceneGenerator {
 public:
  explicit SceneGenerator(unsigned number) : random_(number) {}

  RandomScene operator()() {
    RandomScene s;
    s.apparatus = one_of({"slump_flow", "slump_flow", "slump_flow", "l_box", "icar_vane"});
    s.text = "apparatus = \"" + s.apparatus + "\"\n";
    mix(s);
    test(s);
    model(s);
    s.text += "[output]\nframes = false\n";
    return s;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  double log_uniform(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  template <class T>
  T one_of(std::initializer_list<T> list) {
    return *(list.begin() + std::uniform_int_distribution<std::ptrdiff_t>(
                                0, static_cast<std::ptrdiff_t>(list.size()) - 1)(random_));
  }
  std::string one_of(std::initializer_list<const char*> list) { return one_of<const char*>(list); }
  static std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }
  static std::string line(const std::string& key, double value, const std::string& unit) {
    return key + " = " + (unit.empty() ? number(value) : '"' + number(value) + ' ' + unit + '"') + '\n';
  }
  static std::string word(const std::string& key, const std::string& value) {
    return key + " = \"" + value + "\"\n";
  }

  void mix(RandomScene& s) {
    s.tau_0 = chance(0.15) ? 0.0 : log_uniform(0.1, 5e3);
    s.mu = log_uniform(0.01, 1e3);
    s.K = log_uniform(1e4, 2e9);
    s.herschel_bulkley = chance(0.2);
    s.text += "[mix]\n" + line("yield_stress", s.tau_0, "Pa") + line("bulk_modulus", s.K, "Pa");
    s.text += s.herschel_bulkley
                  ? line("consistency", s.mu, "Pa.s^n") + line("flow_index", uniform(0.2, 2.0), "")
                  : line("plastic_viscosity", s.mu, "Pa.s");
    s.thixotropic = s.tau_0 > 0.0 && chance(0.5);
    if (s.thixotropic) thixotropy(s);
  }
  void thixotropy(RandomScene& s) {
    const std::string kinetics = one_of({"gated", "roussel", "power"});
    s.lambda = chance(0.3) ? 0.0 : log_uniform(0.1, 1e3);
    s.text += "[mix.thixotropy]\n" +
              line("structuration_rate", chance(0.2) ? 0.0 : log_uniform(0.01, 100.0), "Pa/s") +
              line("destructuration", chance(0.2) ? 0.0 : log_uniform(1e-4, 1e3), "") +
              word("kinetics", kinetics) + line("initial_flocculation", s.lambda, "");
    if (kinetics == "power") {
      s.text += line("exponent", uniform(1.0, 5.0), "");
      if (chance(0.5)) s.text += line("saturation", log_uniform(std::max(1.0, s.lambda), 2e3), "");
    }
  }
  void test(RandomScene& s) {
    s.text += "[test]\n";
    if (s.thixotropic && chance(0.3)) s.text += line("rest", log_uniform(1.0, 1e3), "s");
    if (s.apparatus == "icar_vane") {
      s.speed = log_uniform(0.01, 2.0);
      s.duration = std::max(0.5, 0.1 / s.speed);
      s.text += line("speed", s.speed, "rev/s");
    } else {
      s.duration = uniform(0.2, 1.0);
      const std::string key = s.apparatus == "l_box" ? "gate_speed" : "lift_speed";
      s.text += chance(0.25) ? word(key, "instant") : line(key, log_uniform(1e-3, 10.0), "m/s");
    }
    s.text += line("duration", s.duration, "s");
    if (s.apparatus != "slump_flow") return;
    s.contact = one_of({"no_slip", "no_slip", "friction", "free_slip"});
    s.text += "[floor]\n" + word("contact", s.contact);
    if (s.contact == "friction") s.text += line("coefficient", log_uniform(0.01, 1.0), "");
  }
  void model(RandomScene& s) {
    s.space = s.apparatus == "slump_flow" ? (chance(0.75) ? "axisymmetric" : "quarter")
              : s.apparatus == "l_box" ? (chance(0.8) ? one_of({"plane", "plane_with_side_walls"}) : "half")
                                       : (chance(0.75) ? "couette" : "plane");
    const std::string yield = one_of({"exact", "exact", "papanastasiou", "bi_viscous"});
    s.exact = yield == "exact";
    s.text += "[model]\n" + word("space", s.space) + word("yield", yield);
    if (yield == "papanastasiou")
      s.text += line("regularisation", chance(0.1) ? 1e-9 : log_uniform(1e-3, 1e6), "s");
    if (yield == "bi_viscous") s.text += line("critical_shear_rate", log_uniform(1e-6, 100.0), "1/s");
    cells(s);
    if (s.apparatus == "slump_flow" && !s.exact && chance(0.3))
      s.text +=
          word("scheme", one_of({"explicit", "explicit_usf"})) + word("transfer", one_of({"apic", "flip"}));
    else if (chance(0.15))
      s.text += word("transfer", "flip");
  }
  /// Some of one point a cell, some of one cell, else such as are computed within a second.
  void cells(RandomScene& s) {
    const bool space = s.space == "quarter" || s.space == "half";
    const double least = s.space == "couette"                               ? 1e-3
                         : s.space == "plane" && s.apparatus == "icar_vane" ? 0.012
                         : space                                            ? 0.02
                                                                            : 0.008;
    s.cell = log_uniform(least, 0.1);
    s.cell_up = chance(0.5) ? s.cell : std::clamp(s.cell * log_uniform(0.3, 3.0), least, 0.1);
    if (chance(0.02)) s.cell = s.cell_up = 0.4;
    s.text += "cell = [\"" + number(s.cell) + " m\", \"" + number(s.cell_up) + " m\"]\n";
    s.text += "points_per_cell = " +
              std::string(chance(0.1) ? "1"
                          : space     ? "2"
                                      : one_of({"2", "3", "4"})) +
              '\n';
  }

  std::mt19937 random_;
};

}  // namespace tremie::test
