#include "rheometer/fits/decay_stability.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/parameters.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie::fitting {

namespace {

struct Variant {
  const char* name;
  TorqueRecord record;
  bool starts_later = false;
};

template <class Keep>
TorqueRecord rows_of(const TorqueRecord& record, Keep keep) {
  TorqueRecord part = record;
  part.time.clear(), part.torque.clear(), part.line.clear();
  for (std::size_t i = 0; i < record.time.size(); ++i) {
    if (!keep(i)) continue;
    part.time.push_back(record.time[i]);
    part.torque.push_back(record.torque[i]);
    part.line.push_back(record.line[i]);
  }
  return part;
}

TorqueRecord moved(const TorqueRecord& record, double shift) {
  TorqueRecord result = record;
  for (double& t : result.time) t += shift;
  return result;
}

/// The record as it might have been written as well; where too few rows would be left, without that variant.
std::vector<Variant> variants_of(const TorqueRecord& record) {
  constexpr std::size_t fewest = 8;
  const std::size_t n = record.time.size(), fifth = n / 5;
  std::vector<Variant> variants;
  const double first = record.time.front();
  if (first > 0.0) variants.push_back({"the clock moved back by a reading", moved(record, -first)});
  const auto second =
      std::find_if(record.time.begin(), record.time.end(), [&](double t) { return t > first; });
  if (second != record.time.end())
    variants.push_back({"the clock moved by a reading", moved(record, *second - first)});
  if (fifth > 0 && n - fifth >= fewest) {
    variants.push_back(
        {"the first fifth left out", rows_of(record, [&](std::size_t i) { return i >= fifth; }), true});
    variants.push_back(
        {"the last fifth left out", rows_of(record, [&](std::size_t i) { return i < n - fifth; })});
  }
  if (n / 4 >= fewest)
    variants.push_back({"every fourth row", rows_of(record, [](std::size_t i) { return i % 4 == 0; })});
  return variants;
}

/// What the variants give for one parameter.
struct Spread {
  double low = HUGE_VAL, high = -HUGE_VAL;
  const char* furthest = "";

  void add(double value, double of_record, const char* name) {
    if (std::abs(value - of_record) > std::max(of_record - low, high - of_record)) furthest = name;
    low = std::min(low, value), high = std::max(high, value);
  }
};

bool belongs_to_material(const FitParameter& p) {
  return p.member == &FitResult::tau_0 || p.member == &FitResult::mu || p.member == &FitResult::alpha ||
         p.member == &FitResult::breakdown_rate || p.member == &FitResult::exponent;
}

/// What means something else, or nothing, in other kinetics.
bool belongs_to_kinetics(const FitParameter& p) {
  return p.member == &FitResult::alpha || p.member == &FitResult::exponent ||
         p.member == &FitResult::breakdown_rate;
}

void withdraw(const FitParameter& p, const Variant& variant, const FitResult& other, FitResult& result) {
  result.notes.push_back(p.name + ": depends on how the decay was recorded: with " + variant.name +
                         " the kinetics " + other.model + " are chosen; not identifiable from this record");
  (result.*p.member).reset();
}

void widen(const FitParameter& p, const Spread& spread, FitResult& result) {
  auto& e = result.*p.member;
  if (spread.low >= e->ci95->low && spread.high <= e->ci95->high) return;
  const Interval wide{std::min(spread.low, e->ci95->low), std::max(spread.high, e->ci95->high)};
  const bool holds = wide.high - e->value < e->value && e->value < 2.0 * wide.low;
  const std::string goes = text_of(
      "%s: depends on how the decay was recorded: %.3g here, %.3g to %.3g with the clock shifted or rows "
      "left out (furthest: %s)",
      p.name.c_str(), e->value, spread.low, spread.high, spread.furthest);
  result.notes.push_back(
      goes + (holds ? "; its interval is widened by that" : "; not identifiable from this record"));
  if (holds)
    e->ci95 = wide;
  else
    e.reset();
}

}  // namespace

void judge_stability(const TorqueRecord& record, const FitInput& input, FitResult& result) {
  std::vector<std::pair<Variant, FitResult>> fits;
  for (Variant& v : variants_of(record)) try {
      FitResult f = fit_torque_decay(v.record, input, Stability::taken_for_granted);
      fits.emplace_back(std::move(v), std::move(f));
    } catch (const std::exception&) {  // too little is left for a fit: it says nothing
    }
  for (const FitParameter& p : fit_parameters()) {
    if (!p.member || !(result.*p.member) || !(result.*p.member)->ci95 || (result.*p.member)->given) continue;
    Spread spread;
    const double of_record = (result.*p.member)->value;
    const auto other = std::find_if(fits.begin(), fits.end(),
                                    [&](const auto& fit) { return fit.second.model != result.model; });
    if (other != fits.end() && belongs_to_kinetics(p)) {
      withdraw(p, other->first, other->second, result);
      continue;
    }
    for (const auto& [variant, f] : fits)
      if (const auto& e = f.*p.member; e && (!variant.starts_later || belongs_to_material(p)))
        spread.add(e->value, of_record, variant.name);
    if (spread.low <= spread.high) widen(p, spread, result);
  }
}

}  // namespace tremie::fitting
