// Protection levels that hold although landmarks may be others than they seem: one, two, or all.
#pragma once

#include "core/fusion/point_adjustment.h"
#include "core/fusion/position_witness.h"

namespace lodemark {

// That all of what a witness says is displaced, and how far then, 1 sigma a direction: windows are
// taken for the next ones.
struct DisplacementRisk {
  double probability = 0.0;
  double sigma_m = 0.0;
};

// Solution separation over the parts of a witness, as SeparationLevels does it over ranges: widens
// the estimate's protection levels to what its position could be
// - without each part, and where parts fit worse than they should, as much wider as that;
// - without any two of those parts that matter most, as far as two are mistaken at once;
// - if the whole witness is displaced, as likely as that still is beside what else is known: the
//   ranges as they are weighted beside it, and, where there is one (or null), the estimate of the
//   ranges alone, of which none seems wrong for the witness's sake.
// statement: the witness's last one, which the estimate contains. A level is 0 where the fault of a
// part could go unseen. risk: that a level leaves.
void WidenByParts(const PositionWitness& witness, const PositionStatement& statement,
                  const DisplacementRisk& displacement, const PointEstimate* alone, double risk,
                  PointEstimate* estimate);

}  // namespace lodemark
