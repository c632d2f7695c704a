// The report's data as compact JSON: columns of integers in centimetres and milliseconds.
#include <map>

#include "tools/report/json_columns.h"
#include "tools/report/motion_data.h"
#include "tools/report/report.h"
#include "tools/report/scene_data.h"

namespace lodemark {
namespace {

using Number = ReportNumber;

void AppendEpochs(const std::vector<ReportEpoch>& epochs, std::string* json) {
  const auto answered = [](const ReportEpoch& e, double value) {
    return e.answered ? Number(value) : std::nullopt;
  };
  AppendColumn("t", epochs, 1e3, [](const ReportEpoch& e) { return Number(e.time_s); }, json);
  *json += ',';
  AppendColumn("e", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.east_m); }, json);
  *json += ',';
  AppendColumn(
      "n", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.north_m); }, json);
  *json += ',';
  AppendColumn("u", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.up_m); }, json);
  *json += ',';
  AppendColumn("acc", epochs, 1e2, [](const ReportEpoch& e) { return e.accuracy_m; }, json);
  *json += ',';
  AppendColumn(
      "vacc", epochs, 1e2, [](const ReportEpoch& e) { return e.vertical_accuracy_m; }, json);
  *json += ',';
  AppendColumn(
      "ee", epochs, 1e2,
      [](const ReportEpoch& e) { return e.error_m ? Number((*e.error_m)[0]) : std::nullopt; },
      json);
  *json += ',';
  AppendColumn(
      "en", epochs, 1e2,
      [](const ReportEpoch& e) { return e.error_m ? Number((*e.error_m)[1]) : std::nullopt; },
      json);
  *json += ',';
  AppendColumn("eu", epochs, 1e2, [](const ReportEpoch& e) { return e.up_error_m; }, json);
  *json += ',';
  const auto half_width = [](std::size_t axis) {
    return [axis](const ReportEpoch& e) {
      return e.half_width_m ? Number((*e.half_width_m)[axis]) : std::nullopt;
    };
  };
  AppendColumn("we", epochs, 1e2, half_width(0), json);
  *json += ',';
  AppendColumn("wn", epochs, 1e2, half_width(1), json);
  *json += ',';
  AppendColumn("pl", epochs, 1e2, [](const ReportEpoch& e) { return e.protection_level_m; }, json);
  *json += ',';
  AppendColumn(
      "vpl", epochs, 1e2, [](const ReportEpoch& e) { return e.vertical_protection_level_m; }, json);
  *json += ',';
  AppendColumn("nees", epochs, 1e2, [](const ReportEpoch& e) { return e.nees; }, json);
  *json += ',';
  AppendColumn(
      "used", epochs, 1.0,
      [](const ReportEpoch& e) {
        return e.satellites_used ? Number(*e.satellites_used) : std::nullopt;
      },
      json);
  *json += ',';
  AppendArray(
      "ell", epochs,
      [json](const ReportEpoch& e) {
        if (!e.ellipse) {
          *json += '0';
          return;
        }
        *json += '[';
        AppendScaled(e.ellipse->semi_major_m, 1e2, json);
        *json += ',';
        AppendScaled(e.ellipse->semi_minor_m, 1e2, json);
        *json += ',';
        AppendScaled(e.ellipse->azimuth_deg, 1.0, json);
        *json += ']';
      },
      json);
  std::map<std::string, int> places;
  for (const ReportEpoch& epoch : epochs) places.emplace(epoch.status, 0);
  int place = 0;
  for (auto& [status, index] : places) index = place++;
  *json += ',';
  AppendArray(
      "statuses", places, [json](const auto& entry) { *json += JsonString(entry.first); }, json);
  *json += ',';
  AppendArray(
      "status", epochs,
      [&](const ReportEpoch& e) { AppendInteger(places.find(e.status)->second, json); }, json);
  *json += ',';
  AppendMotion(epochs, json);
}

void AppendSignal(const ReportSignal& signal, double rate_step_mps, std::string* json) {
  *json += "{\"sat\":" + JsonString(signal.satellite) + ",\"sig\":" + JsonString(signal.signal);
  *json += ",\"states\":\"";
  for (const ReportSignalState state : signal.states) *json += StateLetter(state);
  *json += "\",\"counts\":[";
  for (const std::int64_t count :
       {signal.seen, signal.used, signal.down_weighted, signal.rejected}) {
    AppendInteger(count, json);
    *json += ',';
  }
  json->back() = ']';
  *json += ",\"reason\":" + JsonString(signal.main_reason) + ",\"cn0mean\":";
  AppendScaled(signal.mean_cn0_dbhz, 10.0, json);
  *json += ",\"rms\":";
  AppendScaled(signal.rms_residual_m, 1e2, json);
  *json += ',';
  AppendColumn("cn0", signal.cn0_dbhz, 1.0, [](Number value) { return value; }, json);
  *json += ',';
  const auto part = [](std::size_t which) {
    return [which](const std::optional<std::array<double, 2>>& direction) {
      return direction ? Number((*direction)[which]) : std::nullopt;
    };
  };
  AppendColumn("az", signal.direction_deg, 1.0, part(0), json);
  *json += ',';
  AppendColumn("el", signal.direction_deg, 1.0, part(1), json);
  *json += ',';
  AppendResiduals(signal, rate_step_mps, json);
  *json += '}';
}

void AppendRun(const ReportRun& run, std::string* json) {
  *json += "{\"name\":" + JsonString(run.name) + ",\"count\":";
  AppendInteger(run.epoch_count, json);
  *json += ",\"span\":";
  AppendScaled(run.span_s, 1e3, json);
  *json += ',';
  AppendEpochs(run.epochs, json);
  *json += ',';
  AppendColumn("cdf", run.error_quantiles_m, 1e2, [](double value) { return Number(value); }, json);
  *json += ',';
  AppendColumn(
      "chance", run.chance_quantiles, 1e3, [](double value) { return Number(value); }, json);
  *json += ',';
  AppendColumn("withinAxes", run.within_half_width, 1e3, [](Number share) { return share; }, json);
  *json += ",\"within\":";
  AppendScaled(run.within_accuracy, 1e3, json);
  *json += ",\"meanNees\":";
  AppendScaled(run.mean_nees, 1e2, json);
  *json += ",\"neesInBand\":";
  AppendScaled(run.nees_in_band, 1e3, json);
  *json += ',';
  AppendVelocityErrors(run.velocity_errors, json);
  const double rate_step_mps = RateStep_mps(run.signals);
  *json += ",\"rateStep\":";
  AppendScaled(rate_step_mps, 1e4, json);
  *json += ',';
  AppendArray(
      "signals", run.signals, [&](const ReportSignal& s) { AppendSignal(s, rate_step_mps, json); },
      json);
  *json += ',';
  AppendArray(
      "events", run.events,
      [json](const ReportEvent& event) {
        *json += '[';
        AppendScaled(event.time_s, 1e3, json);
        *json += ',' + JsonString(event.event) + ',' + JsonString(event.text) + ']';
      },
      json);
  *json += ",\"eventCount\":";
  AppendInteger(run.event_count, json);
  *json += ',';
  AppendSights(run.landmarks, run.sights, json);
  *json += '}';
}

}  // namespace

std::string ReportDataJson(const Report& report) {
  std::string json = "{\"start\":" + JsonString(report.start) + ',';
  using Point = ReportTruthPoint;
  json += "\"truth\":{";
  AppendColumn("t", report.truth, 1e3, [](const Point& p) { return Number(p.time_s); }, &json);
  json += ',';
  AppendColumn("e", report.truth, 1e2, [](const Point& p) { return Number(p.east_m); }, &json);
  json += ',';
  AppendColumn("n", report.truth, 1e2, [](const Point& p) { return Number(p.north_m); }, &json);
  json += ',';
  AppendKnownColumn("speed", report.truth, 1e2, [](const Point& p) { return p.speed_mps; }, &json);
  json += ',';
  AppendKnownColumn("climb", report.truth, 1e2, [](const Point& p) { return p.climb_mps; }, &json);
  json += ",\"byDifferences\":";
  json += report.truth_speed_by_differences ? "true" : "false";
  json += "},";
  AppendScene(report.scene, &json);
  json += ',';
  AppendArray("runs", report.runs, [&](const ReportRun& run) { AppendRun(run, &json); }, &json);
  return json + '}';
}

}  // namespace lodemark
