#pragma once

// [mix.thixotropy]: what all kinetics have, and the keys that each states (libmpm/constitutive/kinetics_interface.hpp).

#include <optional>

#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"
#include "libmpm/constitutive/flocculation.hpp"

namespace tremie::scene {

Section thixotropy_section();

/// Drops the defaults of keys that the scene's kinetics may go without. Throws InputError where the mix has no yield
/// stress, or a layer that has no meaning in the apparatus.
void settle_thixotropy(Values& values, bool layer_has_meaning);

/// Empty without the table.
std::optional<Thixotropy> read_thixotropy(const Values& values);

}  // namespace tremie::scene
