// Protection levels that hold although any one landmark may be another than it seems.
#pragma once

#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_witness.h"

namespace lodemark {

// Solution separation over the parts of a witness, as SeparationLevels does it over ranges: widens
// the estimate's protection levels to what its position could be without each part. statement: the
// witness's last one, which the estimate contains. A level is 0 where the fault of a part could go
// unseen.
void WidenByParts(const PositionWitness& witness, const PositionStatement& statement, double risk,
                  PointEstimate* estimate);

}  // namespace lodemark
