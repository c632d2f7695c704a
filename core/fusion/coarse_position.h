// A rough position from nothing.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/fusion/observation.h"

namespace lodemark {

// Within some kilometres of the truth from satellite ranges without atmosphere, several of them
// wrong: robust least squares from the centre of the earth. Empty if they fix no place near the
// earth's surface.
std::optional<Eigen::Vector3d> CoarsePosition(std::span<const RangeObservation> observations);

}  // namespace lodemark
