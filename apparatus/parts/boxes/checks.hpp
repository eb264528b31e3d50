#pragma once

// When a box stands, how its ratio still changes, and why a result is not to be trusted.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/readings.hpp"
#include "apparatus/parts/boxes/boxes.hpp"

namespace tremie::boxes {

/// A box stands where its depths and its front have moved by less than this for so long: what a person with a rule
/// sees. Films on the walls in space drain for as long as one looks.
inline constexpr double standing_within = 1e-3, standing_lasts = 30.0;  // [m], [s]

/// Since when the box stands [s]; empty while it does not.
std::optional<double> stands_since(const std::vector<Sample>& series);

/// Change of H2/H1 over the last standing_lasts [1/s]; empty where there was none that long ago.
std::optional<double> ratio_change(const std::vector<Sample>& series);

/// The fastest that the front was [m/s].
double fastest_front(const std::vector<Sample>& series);

using View = scene::RunView<Scene, Outcome>;

/// Share of the concrete that may go through the shut part of the gate or the front wall.
inline constexpr double most_through_the_wall = 0.002;
/// A reason where more did; else empty.
std::string went_through_the_wall(const View& run);

/// Adds the reasons of all checks.
void add_reasons(const Scene& scene, Outcome& outcome);

}  // namespace tremie::boxes
