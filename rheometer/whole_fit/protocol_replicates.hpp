#pragma once

// Protocols of several records of one material side by side: the law of their flow curves, and the means of what the whole
// records and their sections tell.

#include <string>
#include <vector>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/whole_fit/replicates.hpp"

namespace tremie {

/// The law of the flow curve that a record's other sections take; empty where it has none.
std::string law_read(const ProtocolReading& reading);

/// One material has one law: the one that most of the records have, of equally many the one with more parameters. Empty
/// where none of them has a law.
std::string common_law(const std::vector<ProtocolReading>& readings);

/// The parameters of the flow curves of the common law, A_thix, k, a and saturation of the whole records; then the static
/// yield stress after each rest, and what decays at one speed after one rest tell by the kinetics that most of them have. A
/// single peak has no interval: that of its mean is by the scatter between the records.
std::vector<ReplicateMean> replicate_means(const std::vector<ProtocolReading>& readings);

}  // namespace tremie
