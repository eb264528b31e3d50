#pragma once

#include <string>

#include "apparatus/scene/values.hpp"

namespace tremie::scene {

/// The scene with every value that it uses, in SI, as TOML that reads back to the same values bit for bit.
/// Defaults are marked "# default", values of a preset "# preset", overrides "# --set".
std::string write_resolved(const Schema& schema, const Values& values);

/// A commented scene to start from: every key with its default, its meaning and what is allowed.
std::string write_template(const ApparatusKeys& apparatus);

}  // namespace tremie::scene
