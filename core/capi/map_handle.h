// What a lodemark_map points to.
#pragma once

#include <memory>

#include "core/geo/geodetic.h"
#include "core/map/feature_map.h"
#include "lodemark/lodemark.h"

struct lodemark_map {
  std::unique_ptr<lodemark::FeatureMap> map;
  lodemark::EnuFrame frame;
};
