#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>

#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::cli {

/// The SI value of an option, which is a quantity greater than 0 with a unit; empty where it is not given. Throws
/// scene::InputError that names the option. Where the unit is missing, one is suggested whose value is `sensible`.
inline std::optional<double> quantity(const char* option, const std::string& text, scene::Dimension dimension,
                                      const std::function<bool(double)>& sensible = {}) {
  if (text.empty()) return std::nullopt;
  try {
    const double value = scene::parse_quantity(text, dimension, sensible);
    if (!(value > 0.0)) throw std::invalid_argument(fmt::format("\"{}\" is not greater than 0", text));
    return value;
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(fmt::format("{}: {}", option, error.what()));
  }
}

}  // namespace tremie::cli
