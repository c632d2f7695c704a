// The HTML report of one or more runs: one self-contained file that needs no network.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/report/scene.h"

namespace lodemark {

// Coordinates are metres east, north and up of the report's origin; times are seconds since its
// start.
struct ReportTruthPoint {
  double time_s = 0.0;
  double east_m = 0.0;
  double north_m = 0.0;
  std::optional<double> speed_mps = {};  // horizontal
  std::optional<double> climb_mps = {};
};

struct ReportEllipse {
  double semi_major_m = 0.0;  // of the 68 % ellipse
  double semi_minor_m = 0.0;
  double azimuth_deg = 0.0;  // of the major axis, clockwise from north
};

struct ReportEpoch {
  double time_s = 0.0;
  bool answered = false;
  double east_m = 0.0;
  double north_m = 0.0;
  double up_m = 0.0;
  std::optional<double> accuracy_m;                   // 68 % radius
  std::optional<double> vertical_accuracy_m;          // 68 % half-width
  std::optional<std::array<double, 2>> half_width_m;  // of the middle 68 %: east, north
  std::optional<ReportEllipse> ellipse;
  std::optional<double> protection_level_m;
  std::optional<double> vertical_protection_level_m;
  std::optional<std::array<double, 2>> error_m;  // east, north: estimate minus truth
  std::optional<double> up_error_m;
  std::optional<double> nees;  // squared error in units of its covariance: 3 on average if honest
  std::optional<int> satellites_used;
  std::optional<double> speed_mps;           // horizontal
  std::optional<double> climb_mps;           // upwards
  std::optional<double> speed_accuracy_mps;  // 68 % radius of the horizontal velocity
  std::optional<double> clock_bias_m;        // receiver minus GPS, times the speed of light
  std::optional<double> clock_drift_mps;
  std::string sources;  // "gnss", "gnss+inertial": what carried the answer, joined by '+'
  std::string status;   // "fix", or why there is no answer
};

// The residual of largest magnitude in a slice of time, and what became of its signal.
struct ReportResidual {
  double value = 0.0;
  ReportSignalState state = ReportSignalState::kUsed;
};

// One signal of one satellite. The slices divide the run's span evenly; a state is that of most of
// their epochs.
struct ReportSignal {
  std::string satellite;  // "G07"
  std::string signal;     // "1C"
  std::vector<ReportSignalState> states;
  std::vector<std::optional<double>> cn0_dbhz;
  std::vector<std::optional<std::array<double, 2>>> direction_deg;  // azimuth, elevation
  std::vector<std::optional<ReportResidual>> code_residual_sigmas;
  std::vector<std::optional<ReportResidual>> rate_residual_mps;
  std::int64_t code_residuals = 0;  // of used epochs
  std::int64_t beyond_3_sigma = 0;  // of these
  std::int64_t seen = 0;            // epochs
  std::int64_t used = 0;            // down-weighted ones included
  std::int64_t down_weighted = 0;
  std::int64_t rejected = 0;
  std::string main_reason;  // the most frequent reason for not being used
  std::optional<double> mean_cn0_dbhz;
  std::optional<double> rms_residual_m;  // of used epochs
};

// Magnitudes of estimate minus truth, over all epochs.
struct ReportVelocityErrors {
  std::optional<std::array<double, 2>> horizontal_mps;  // 50 and 95 % below
  std::optional<std::array<double, 2>> up_mps;
  std::optional<double> within_accuracy;  // share inside the stated 68 % radius
};

struct ReportEvent {
  double time_s = 0.0;
  std::string event;
  std::string text;
};

struct ReportRun {
  std::string name;
  std::vector<ReportEpoch> epochs;  // those drawn
  std::int64_t epoch_count = 0;     // those there are
  double span_s = 0.0;
  std::vector<double> error_quantiles_m;  // horizontal, at equal steps of share from 0 to 1
  // Share of the stated horizontal distribution that is nearer than the truth, at the same steps;
  // evenly spread if the stated one is honest.
  std::vector<double> chance_quantiles;
  // Shares of epochs within the middle 68 % of each axis: east, north, up.
  std::array<std::optional<double>, 3> within_half_width;
  std::optional<double> within_accuracy;  // share inside the stated 68 % radius
  std::optional<double> mean_nees;
  std::optional<double> nees_in_band;  // share within the middle 95 % of chi-square
  ReportVelocityErrors velocity_errors;
  std::vector<ReportSignal> signals;
  std::vector<ReportEvent> events;
  std::int64_t event_count = 0;
  std::vector<ReportSignalState> landmarks;  // one for each of the scene's, or none
  std::vector<ReportSights> sights;
};

struct ReportTableRow {
  bool section = false;
  std::string label;
  std::vector<std::string> values;  // one per run; empty: unknown
  std::string unit;
};

struct ReportFigure {
  std::string label;
  std::string value;
  std::string unit;
  std::string note;
  std::optional<std::size_t> run = {};  // whose it is, where there are several
};

struct Report {
  std::string title;
  std::string subtitle;               // what, where, when
  std::string generator;              // "lodemark 0.1.0"
  std::vector<ReportFigure> figures;  // the few numbers a reader wants first
  std::vector<ReportTableRow> table;
  std::vector<ReportRun> runs;
  ReportScene scene;
  std::vector<ReportTruthPoint> truth;      // empty: none known; one: a place at rest
  bool truth_speed_by_differences = false;  // of its positions, as it states no velocity
  std::string start;                        // date and time of time_s = 0, for the reader
};

// The whole page. Texts may hold anything; they arrive on the page as text.
std::string ReportHtml(const Report& report);

// The data the page's script draws, as JSON in which no '<' occurs.
std::string ReportDataJson(const Report& report);

// Text for use in HTML content and attribute values.
std::string EscapeHtml(std::string_view text);

// A JSON string with its quotes. Malformed UTF-8 is replaced; '<', '>', '&' and the line separators
// that scripts stumble over are written as escapes.
std::string JsonString(std::string_view text);

}  // namespace lodemark
