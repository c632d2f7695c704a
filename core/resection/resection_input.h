// Whether what a resection is given is input at all.
#pragma once

#include <span>

#include "core/base/result.h"
#include "core/resection/resection.h"
#include "core/resection/sights.h"

namespace lodemark {

Status CheckResectionInput(std::span<const LandmarkSight> sights, const ResectionPriors& priors,
                           const ResectionOptions& options);

}  // namespace lodemark
