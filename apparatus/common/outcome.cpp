#include "apparatus/common/outcome.hpp"

#include <algorithm>
#include <cmath>

namespace tremie::scene {

ResultValue number(std::optional<double> value, double factor) {
  if (!value || !std::isfinite(*value)) return std::monostate{};
  return *value * factor;
}

const ResultValue* find_result(const Outcome& outcome, const std::string& name) {
  const auto found = std::find_if(outcome.results.begin(), outcome.results.end(),
                                  [&](const Result& r) { return r.name == name; });
  return found == outcome.results.end() ? nullptr : &found->value;
}

std::optional<double> find_number(const Outcome& outcome, const std::string& name) {
  const ResultValue* value = find_result(outcome, name);
  const double* number = value ? std::get_if<double>(value) : nullptr;
  return number ? std::optional(*number) : std::nullopt;
}

const Column* find_column(const std::vector<Column>& columns, const std::string& name) {
  const auto found =
      std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

const std::vector<Column>& columns_of(const Chart& chart, const Outcome& outcome) {
  static const std::vector<Column> none;
  if (chart.table.empty()) return outcome.series;
  const auto found = std::find_if(outcome.tables.begin(), outcome.tables.end(),
                                  [&](const ResultTable& t) { return t.file == chart.table; });
  return found == outcome.tables.end() ? none : found->columns;
}

}  // namespace tremie::scene
