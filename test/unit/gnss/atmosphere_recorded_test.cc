// Ionosphere and troposphere against a professional simulator's truth for every satellite.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/units.h"
#include "core/gnss/ionosphere.h"
#include "core/gnss/troposphere.h"
#include "core/logs/line_reader.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

constexpr const char* kFile =
    "gnss/spirent_static_20230108/iono-klob_tropo-saastamoinen.satellites.csv.gz";
constexpr std::int64_t kStart_gps_ns = 1'357'207'140 * kSecond_ns;  // from the file's second line
constexpr Geodetic kPlace = {30.0 * kRadiansPerDegree, 95.0 * kRadiansPerDegree, 0.0};

struct SatelliteTruth {
  std::string system;
  std::int64_t time_gps_ns = 0;
  LookAngles look;
  double ionosphere_m[6] = {};
  double troposphere_m = 0.0;
};

std::vector<double> Numbers(std::string_view line, std::string* system) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string_view field = line.substr(0, comma);
    double value = 0.0;
    std::from_chars(field.data(), field.data() + field.size(), value);
    if (numbers.size() == 2) *system = std::string(field);
    numbers.push_back(value);
    if (comma == std::string_view::npos) return numbers;
    line.remove_prefix(comma + 1);
  }
}

// The file's own angles have four digits, 300 mm of slant delay near the horizon; its positions
// have a tenth of a millimetre.
std::vector<SatelliteTruth> ReadTruth() {
  std::vector<SatelliteTruth> rows;
  Result<LineReader> lines = LineReader::Open(test::RecordingPath(kFile));
  if (!lines.ok()) return rows;
  const Eigen::Vector3d place_in_ecef = EcefFromGeodetic(kPlace);
  const Eigen::Matrix3d enu_from_ecef = EnuFromEcefRotation(kPlace);
  std::string_view line;
  while (lines->Next(&line)) {
    if (lines->line_number() <= 5) continue;
    SatelliteTruth row;
    const std::vector<double> v = Numbers(line, &row.system);
    if (v.size() < 29) continue;
    row.time_gps_ns = kStart_gps_ns + static_cast<std::int64_t>(v[0]) * kMillisecond_ns;
    row.look = LookAnglesTo({v[6], v[7], v[8]}, place_in_ecef, enu_from_ecef);
    for (std::size_t i = 0; i < 6; ++i) row.ionosphere_m[i] = kSpeedOfLight_mps * v[22 + i];
    row.troposphere_m = kSpeedOfLight_mps * v[28];
    rows.push_back(row);
  }
  return rows;
}

TEST(RecordedAtmosphere, TroposphereIsTheSimulatorsToAMillimetre) {
  LODEMARK_NEEDS_RECORDING(kFile);
  const std::vector<SatelliteTruth> truth = ReadTruth();
  ASSERT_EQ(truth.size(), 2114u);
  // The simulator does not state its weather: standard pressure, and the vapour that makes up the
  // rest of its zenith delay.
  const ZenithDelay zenith = SaastamoinenZenithDelay({1013.25, 288.15, 13.5}, kPlace);
  double worst_m = 0.0;
  double worst_default_m = 0.0;
  for (const SatelliteTruth& row : truth) {
    const MappingFactors mapping = NiellMapping(kPlace, row.time_gps_ns).At(row.look.elevation_rad);
    const double delay_m = mapping.hydrostatic * zenith.hydrostatic_m + mapping.wet * zenith.wet_m;
    worst_m = std::max(worst_m, std::abs(delay_m - row.troposphere_m));
    const double default_m =
        TroposphereDelay(kPlace, row.look.elevation_rad, row.time_gps_ns, nullptr);
    worst_default_m =
        std::max(worst_default_m, std::abs(default_m - row.troposphere_m) / mapping.hydrostatic);
  }
  EXPECT_LT(worst_m, 0.001);
  // The climate of 30 degrees north in January has 1020.8 hPa: 17 mm more at the zenith.
  EXPECT_LT(worst_default_m, 0.018);
}

// Coefficients and carrier that the simulator uses for a system's first column, or none.
struct KlobucharUse {
  const char* system;
  std::size_t column;
  KlobucharParameters parameters;
  double frequency_hz;
};

constexpr KlobucharUse kUses[] = {
    {"GPS",
     0,
     {System::kGps,
      {2.4214e-08, 7.4506e-09, -1.1921e-07, 5.9605e-08},
      {1.4746e+05, -1.9661e+05, 0.0, 2.6214e+05}},
     1575.42e6},
    {"GPS",
     2,
     {System::kGps,
      {2.4214e-08, 7.4506e-09, -1.1921e-07, 5.9605e-08},
      {1.4746e+05, -1.9661e+05, 0.0, 2.6214e+05}},
     1176.45e6},
    // GPS's coefficients for QZSS too, and NavIC's own, on L5.
    {"Quasi-Zenith",
     0,
     {System::kQzss,
      {2.4214e-08, 7.4506e-09, -1.1921e-07, 5.9605e-08},
      {1.4746e+05, -1.9661e+05, 0.0, 2.6214e+05}},
     1575.42e6},
    {"IRNSS",
     2,
     {System::kNavic,
      {4.5635e-08, 3.1292e-07, -8.9407e-07, -7.5102e-06},
      {1.4131e+05, -1.3107e+05, -8.3231e+06, 8.3231e+06}},
     1176.45e6},
    // The simulator puts BeiDou's coefficients into the GPS formula, as if they were for L1; the
    // BeiDou document's formula and carrier differ from that by up to 25 %.
    {"BeiDou",
     0,
     {System::kGps,
      {3.3528e-08, 6.7055e-08, -1.0133e-06, 1.6093e-06},
      {1.1878e+05, 3.2768e+04, 7.8643e+05, -7.8643e+05}},
     1561.098e6},
};

TEST(RecordedAtmosphere, KlobucharIsTheSimulatorsToTwoMillimetres) {
  LODEMARK_NEEDS_RECORDING(kFile);
  const std::vector<SatelliteTruth> truth = ReadTruth();
  for (const KlobucharUse& use : kUses) {
    int compared = 0;
    int apart = 0;
    for (const SatelliteTruth& row : truth) {
      // A column of zeros is a carrier that the satellite lacks; BeiDou's third generation, whose
      // ionosphere the simulator takes from BDGIM, has the fourth column.
      if (row.system != use.system || row.ionosphere_m[use.column] == 0.0) continue;
      const double delay_m =
          KlobucharDelay(use.parameters, kPlace, row.look, row.time_gps_ns, use.frequency_hz);
      if (std::abs(delay_m - row.ionosphere_m[use.column]) > 0.002) ++apart;
      ++compared;
    }
    EXPECT_GT(compared, 100) << use.system;
    // The day ends at |x| = 1.57 (IS-GPS-200N), 2 % of the amplitude above the night; for the
    // simulator at pi / 2. Two of NavIC's rows lie between.
    EXPECT_LE(apart, 2) << use.system << " column " << use.column;
  }
}

// The simulator's third generation of BeiDou sees BDGIM, whose nine coefficients its files do not
// hold. The delay is linear in them, and a fit leaves nothing of the slant delays at 490 places in
// the sky down to the horizon: harmonics, prediction and mapping function are the simulator's.
// (With the mapping function of CODE, which a program of the model's authors uses, 35 mm RMS are
// left.)
TEST(RecordedAtmosphere, NineCoefficientsMakeBdgimTheSimulatorsToAMillimetre) {
  LODEMARK_NEEDS_RECORDING(kFile);
  constexpr double kBase_tecu = 100.0;  // far from where the model is cut off at zero
  std::vector<SatelliteTruth> rows = ReadTruth();
  std::erase_if(rows, [](const SatelliteTruth& row) {
    return row.system != "BeiDou" || row.ionosphere_m[3] == 0.0;
  });
  ASSERT_EQ(rows.size(), 490u);
  Eigen::MatrixXd slopes(rows.size(), 9);
  Eigen::VectorXd rest_m(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SatelliteTruth& row = rows[i];
    const auto delay_m = [&](const BdgimParameters& parameters) {
      return BdgimDelay(parameters, PredictBdgim(row.time_gps_ns), kPlace, row.look,
                        row.time_gps_ns, 1575.42e6);
    };
    const BdgimParameters base = {{kBase_tecu}};
    const auto k = static_cast<Eigen::Index>(i);
    rest_m[k] = row.ionosphere_m[3] - delay_m(base);
    for (std::size_t j = 0; j < 9; ++j) {
      BdgimParameters more = base;
      more.alpha[j] += 1.0;
      slopes(k, static_cast<Eigen::Index>(j)) = delay_m(more) - delay_m(base);
    }
  }
  Eigen::VectorXd alpha = slopes.colPivHouseholderQr().solve(rest_m);
  EXPECT_LT((rest_m - slopes * alpha).cwiseAbs().maxCoeff(), 0.001);
  alpha[0] += kBase_tecu;
  // What was sent are multiples of the message's unit, 1/8 TECu.
  for (Eigen::Index j = 0; j < 9; ++j) {
    EXPECT_NEAR(alpha[j], std::round(8.0 * alpha[j]) / 8.0, 0.01) << j;
  }
}

// The simulator's Galileo satellites see NeQuick-G. NTCM-G is another model of the same
// coefficients: its authors find 3 to 4 TECu between them on average, 0.6 m on L1 in the vertical.
TEST(RecordedAtmosphere, NtcmGIsNearNeQuickG) {
  LODEMARK_NEEDS_RECORDING(kFile);
  constexpr GalileoIonosphereParameters kMessage = {{142.5, -0.46484, -0.0064392}, 0};
  double sum_m = 0.0;
  double sum_nequick_m = 0.0;
  for (const SatelliteTruth& row : ReadTruth()) {
    if (row.system != "GALILEO") continue;
    const double delay_m = NtcmGDelay(kMessage, SeasonOfNtcmG(row.time_gps_ns), kPlace, row.look,
                                      row.time_gps_ns, 1575.42e6);
    EXPECT_NEAR(delay_m, row.ionosphere_m[0], 7.0);
    sum_m += delay_m;
    sum_nequick_m += row.ionosphere_m[0];
  }
  EXPECT_NEAR(sum_m / sum_nequick_m, 1.15, 0.15);
}

}  // namespace
}  // namespace lodemark
