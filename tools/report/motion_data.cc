#include "tools/report/motion_data.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/report/json_columns.h"

namespace lodemark {
namespace {

constexpr double kCodeStep_sigmas = 0.25;
constexpr double kLevels = 31.0;  // on either side of zero

using Residuals = std::vector<std::optional<ReportResidual>>;

char LevelDigit(double value, double step) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const double level = std::clamp(std::round(value / step), -kLevels, kLevels);
  return kDigits[static_cast<std::size_t>(level + kLevels)];
}

// Two texts with one character for each slice.
void AppendLevels(const char* levels_name, const char* states_name, const Residuals& residuals,
                  double step, std::string* json) {
  std::string levels, states;
  if (std::any_of(residuals.begin(), residuals.end(),
                  [](const auto& r) { return r.has_value(); })) {
    for (const std::optional<ReportResidual>& residual : residuals) {
      levels +=
          residual && std::isfinite(residual->value) ? LevelDigit(residual->value, step) : '-';
      states += residual ? StateLetter(residual->state) : '-';
    }
  }
  *json += JsonString(levels_name) + ":\"" + levels + "\"," + JsonString(states_name) + ":\"" +
           states + '"';
}

void AppendPair(const char* name, const std::optional<std::array<double, 2>>& pair,
                std::string* json) {
  *json += JsonString(name) + ":[";
  if (pair) {
    AppendScaled((*pair)[0], 1e3, json);
    *json += ',';
    AppendScaled((*pair)[1], 1e3, json);
  }
  *json += ']';
}

}  // namespace

void AppendMotion(const std::vector<ReportEpoch>& epochs, std::string* json) {
  using Epoch = ReportEpoch;
  AppendKnownColumn("speed", epochs, 1e2, [](const Epoch& e) { return e.speed_mps; }, json);
  *json += ',';
  AppendKnownColumn("climb", epochs, 1e2, [](const Epoch& e) { return e.climb_mps; }, json);
  *json += ',';
  AppendKnownColumn("sacc", epochs, 1e2, [](const Epoch& e) { return e.speed_accuracy_mps; }, json);
  *json += ',';
  AppendKnownColumn("bias", epochs, 10.0, [](const Epoch& e) { return e.clock_bias_m; }, json);
  *json += ',';
  AppendKnownColumn("drift", epochs, 1e2, [](const Epoch& e) { return e.clock_drift_mps; }, json);
  std::map<std::string, int> places;
  for (const Epoch& epoch : epochs) places.emplace(epoch.sources, 0);
  int place = 0;
  for (auto& [sources, index] : places) index = place++;
  *json += ',';
  AppendArray(
      "sources", places, [json](const auto& entry) { *json += JsonString(entry.first); }, json);
  *json += ',';
  AppendArray(
      "source", epochs,
      [&](const Epoch& e) { AppendInteger(places.find(e.sources)->second, json); }, json);
}

void AppendVelocityErrors(const ReportVelocityErrors& errors, std::string* json) {
  *json += "\"velocityErrors\":{";
  AppendPair("horizontal", errors.horizontal_mps, json);
  *json += ',';
  AppendPair("up", errors.up_mps, json);
  *json += ",\"within\":";
  AppendScaled(errors.within_accuracy, 1e3, json);
  *json += '}';
}

double RateStep_mps(const std::vector<ReportSignal>& signals) {
  constexpr double kFinest_mps = 1e-4;
  std::vector<double> magnitudes;
  for (const ReportSignal& signal : signals) {
    for (const std::optional<ReportResidual>& residual : signal.rate_residual_mps) {
      if (residual) magnitudes.push_back(std::abs(residual->value));
    }
  }
  if (magnitudes.empty()) return kFinest_mps;
  // Twice what nine in ten stay below fills the levels.
  const auto high = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() * 9 / 10);
  std::nth_element(magnitudes.begin(), high, magnitudes.end());
  const double step = std::ceil(2.0 * std::min(*high, 1e6) / kLevels / kFinest_mps);
  return std::max(1.0, step) * kFinest_mps;
}

void AppendResiduals(const ReportSignal& signal, double rate_step_mps, std::string* json) {
  AppendLevels("code", "codeStates", signal.code_residual_sigmas, kCodeStep_sigmas, json);
  *json += ',';
  AppendLevels("rate", "rateStates", signal.rate_residual_mps, rate_step_mps, json);
  *json += ",\"beyond\":[";
  AppendInteger(signal.beyond_3_sigma, json);
  *json += ',';
  AppendInteger(signal.code_residuals, json);
  *json += ']';
}

}  // namespace lodemark
