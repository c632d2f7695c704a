// Velocity, clock, sources and residuals as parts of the report's data.
#pragma once

#include <string>
#include <vector>

#include "tools/report/report.h"

namespace lodemark {

// "speed":[...],"climb":[...],"sacc":[...],"bias":[...],"drift":[...],"sources":[...],"source":[...]
// A column that no epoch knows is empty; of "sources" each names its words, "source" the place of
// each epoch's.
void AppendMotion(const std::vector<ReportEpoch>& epochs, std::string* json);

// "velocityErrors":{...}
void AppendVelocityErrors(const ReportVelocityErrors& errors, std::string* json);

// Metres per second that a level of a Doppler residual stands for, such that the levels hold what
// is usual; a multiple of 0.1 mm/s.
double RateStep_mps(const std::vector<ReportSignal>& signals);

// "code":"...","codeStates":"...","rate":"...","rateStates":"...","beyond":[...]: a level and a
// state for each slice. Levels are digits of Base64: 31 is zero, 0 and 62 are all that lies beyond,
// '-' is none. A level of code is a quarter of a sigma. Texts without a value are empty.
void AppendResiduals(const ReportSignal& signal, double rate_step_mps, std::string* json);

}  // namespace lodemark
