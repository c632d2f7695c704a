// Real satellites with simulated landmarks: the Pixel 5 drive with all, three and two satellites
// and with none at all for a minute, beside photographs drawn around the true path.
//
//   outage_tables [EPOCHS]    default 1000; docs/experiments.md holds what it prints
//
// Exits with 1 where a figure that must hold does not, with 77 without the recording.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "test/experiments/drive_session.h"
#include "test/experiments/error_statistics.h"
#include "test/recordings.h"

namespace lodemark {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr const char* kRecording = "gnss/pixel5_mtv_20210428";
constexpr std::size_t kOutageEpochs = 60;

struct NamedStreet {
  const char* name;
  Street street;
};

// Landmarks every 4 m on either side as a shopping street has them; every 16 m; and seen and mapped
// so badly that one photograph alone is worse than the satellites.
const NamedStreet kStreets[] = {
    {"many", {}},
    {"few", {StreetNoise(), 16.0, 60.0, 0.6, 40}},
    {"poor", {StreetNoise{8.0, 2.0, 0.1, 0.03, 0.15}, 8.0, 60.0, 0.5, 40}},
};

std::optional<PositionError> ErrorOf(const DriveRecording& drive, const DriveAnswer& answer) {
  const SessionEstimate& estimate = answer.estimate;
  if (estimate.status != EstimateStatus::kFix) return std::nullopt;
  const std::optional<Eigen::Vector3d> truth = drive.TruthAt(estimate.time_gps_ns);
  if (!truth) return std::nullopt;
  PositionError error;
  error.enu_m =
      EnuFromEcefRotation(GeodeticFromEcef(*truth)) * (estimate.position_in_ecef - *truth);
  error.covariance_enu_m2 = estimate.covariance_enu_m2;
  error.bound_enu_m2 = answer.bound_enu_m2;
  return error;
}

ErrorStatistics Sum(const DriveRecording& drive, const std::vector<DriveAnswer>& answers,
                    const EpochSpan& span) {
  ErrorStatistics sum;
  for (std::size_t i = span.first; i < span.first + span.count && i < answers.size(); ++i) {
    const std::optional<PositionError> error = ErrorOf(drive, answers[i]);
    if (error) {
      sum.Add(*error);
    } else {
      sum.AddUnanswered();
    }
  }
  return sum;
}

// Mean product of the errors, east, north, up.
Eigen::Matrix3d SecondMoments(const DriveRecording& drive,
                              const std::vector<DriveAnswer>& answers) {
  Eigen::Matrix3d sum_m2 = Eigen::Matrix3d::Zero();
  int count = 0;
  for (const DriveAnswer& answer : answers) {
    const std::optional<PositionError> error = ErrorOf(drive, answer);
    if (!error) continue;
    sum_m2 += error->enu_m * error->enu_m.transpose();
    ++count;
  }
  return sum_m2 / std::max(count, 1);
}

// Root mean square that no estimate of single epochs goes below, if the satellites' errors are
// normal with the moments that they turned out to have, and the photographs' as drawn.
double BestBeside(const Eigen::Matrix3d& of_satellites_m2,
                  const std::vector<std::optional<DrawnPhoto>>& photos) {
  const Eigen::Matrix3d of_satellites_pm2 = of_satellites_m2.inverse();
  double traces_m2 = 0.0;
  for (const std::optional<DrawnPhoto>& photo : photos) {
    Eigen::Matrix3d information_pm2 = of_satellites_pm2;
    if (photo) information_pm2 += photo->information_pm2;
    traces_m2 += information_pm2.inverse().trace();
  }
  return std::sqrt(traces_m2 / static_cast<double>(std::max<std::size_t>(photos.size(), 1)));
}

void Print(const char* scheme, const char* satellites, const char* landmarks,
           const ErrorStatistics& row, double gnss_m) {
  std::printf("| %s | %s | %s | %.1f %% |", scheme, satellites, landmarks,
              100.0 * row.answered_share());
  if (row.answered() == 0) {
    std::printf(" | | | | | | |\n");
    return;
  }
  const Eigen::Vector3d rmse_m = row.rmse_enu_m();
  std::printf(" %.2f | %.2f | %.2f |", rmse_m.head<2>().norm(), rmse_m.z(), row.rmse_m());
  if (gnss_m > 0.0) {
    std::printf(" %.0f %% |", 100.0 * (1.0 - row.rmse_m() / gnss_m));
  } else {
    std::printf(" |");
  }
  if (row.bound_m() > 0.0) {
    std::printf(" %.2f |", row.bound_m());
  } else {
    std::printf(" |");
  }
  std::printf(" %.2f | %.1f %% |\n", row.nees(), 100.0 * row.within_68());
}

void PrintHeader(const char* title, const char* what) {
  std::printf(
      "\n%s\n\n| scheme | satellites | %s | answered | horizontal m | up m | 3D m | below GNSS in "
      "full view | bound of the photographs alone m | NEES / 3 | in the 68 %% ellipsoid |\n| --- | "
      "--- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      title, what);
}

int Main(std::size_t epochs) {
  const Result<DriveRecording> drive = ReadDrive(test::RecordingPath(kRecording));
  if (!drive) {
    std::fprintf(stderr, "outage_tables: %s\n", drive.error().message.c_str());
    return 1;
  }
  DriveSession session(*drive, epochs);
  const EpochSpan whole = {0, session.epochs()};
  int missed = 0;
  const auto must = [&missed](bool holds, const char* what) {
    if (!holds) std::printf("\nMISSED: %s\n", what);
    missed += holds ? 0 : 1;
  };

  const std::vector<DriveAnswer> gps_answers = session.Replay({Scheme::kGnss}, {});
  const std::vector<DriveAnswer> all_answers = session.Replay({Scheme::kGnss, true}, {});
  const ErrorStatistics gps = Sum(*drive, gps_answers, whole);
  const ErrorStatistics all = Sum(*drive, all_answers, whole);
  PrintHeader("Satellites alone", "landmarks");
  Print("gnss", "GPS", "none", gps, 0.0);
  Print("gnss", "all systems, precise", "none", all, 0.0);
  for (const auto& [all_systems, name] :
       {std::pair(false, "GPS"), std::pair(true, "all systems, precise")}) {
    const DriveRun run = {Scheme::kGnss, all_systems, 0, {}, Estimator::kFilter};
    Print("ekf", name, "none", Sum(*drive, session.Replay(run, {}), whole), 0.0);
  }
  for (const int satellites : {3, 2}) {
    const DriveRun run = {Scheme::kGnss, false, satellites, {}};
    Print("gnss", std::to_string(satellites).c_str(), "none",
          Sum(*drive, session.Replay(run, {}), whole), 0.0);
  }

  // A minute in the middle of the way.
  const EpochSpan outage = {session.epochs() / 2, std::min(kOutageEpochs, session.epochs() / 4)};
  for (const NamedStreet& street : kStreets) {
    const auto photos = session.Photograph(street.street, kSeed);
    PrintHeader(("Landmarks: " + std::string(street.name)).c_str(), "landmarks");
    const auto row = [&](const DriveRun& run, const char* scheme, const char* satellites,
                         double gnss_m) {
      const ErrorStatistics sum = Sum(*drive, session.Replay(run, photos), whole);
      Print(scheme, satellites, street.name, sum, gnss_m);
      return sum;
    };
    row({Scheme::kVision}, "vision", "none", gps.rmse_m());
    row({Scheme::kTightDiagonal}, "tight-diagonal", "GPS", gps.rmse_m());
    const ErrorStatistics tight = row({Scheme::kTight}, "tight", "GPS", gps.rmse_m());
    const ErrorStatistics joint = row({Scheme::kJoint}, "joint", "GPS", gps.rmse_m());
    row({Scheme::kJoint, false, 3, {}}, "joint", "3", gps.rmse_m());
    row({Scheme::kJoint, false, 2, {}}, "joint", "2", gps.rmse_m());
    const ErrorStatistics joint_all =
        row({Scheme::kJoint, true}, "joint", "all systems, precise", all.rmse_m());
    row({Scheme::kJoint, false, 0, {}, Estimator::kFilter}, "ekf", "GPS", gps.rmse_m());
    row({Scheme::kJoint, false, 2, {}, Estimator::kFilter}, "ekf", "2", gps.rmse_m());
    row({Scheme::kJoint, true, 0, {}, Estimator::kFilter}, "ekf", "all systems, precise",
        all.rmse_m());

    const auto best = [&](const char* satellites, const std::vector<DriveAnswer>& answers,
                          double gnss_m) {
      const double best_m = BestBeside(SecondMoments(*drive, answers), photos);
      std::printf("\n%s beside these photographs: at best %.2f m, %.0f %% below\n", satellites,
                  best_m, 100.0 * (1.0 - best_m / gnss_m));
    };
    best("GPS", gps_answers, gps.rmse_m());
    best("All systems", all_answers, all.rmse_m());

    PrintHeader("A minute without any satellite", "when");
    struct Way {
      Scheme scheme;
      Estimator estimator;
      const char* name;
    };
    for (const auto& [scheme, estimator, name] : {Way{Scheme::kGnss, Estimator::kEpoch, "gnss"},
                                                  Way{Scheme::kTight, Estimator::kEpoch, "tight"},
                                                  Way{Scheme::kJoint, Estimator::kEpoch, "joint"},
                                                  Way{Scheme::kJoint, Estimator::kFilter, "ekf"}}) {
      const DriveRun run = {scheme, false, 0, outage, estimator};
      const std::vector<DriveAnswer> answers = session.Replay(run, photos);
      const EpochSpan before = {outage.first - outage.count, outage.count};
      const EpochSpan after = {outage.first + outage.count, outage.count};
      Print(name, "GPS", "before", Sum(*drive, answers, before), gps.rmse_m());
      const ErrorStatistics during = Sum(*drive, answers, outage);
      Print(name, "none", "the minute", during, gps.rmse_m());
      Print(name, "GPS", "after", Sum(*drive, answers, after), gps.rmse_m());
      if (estimator == Estimator::kFilter) {
        must(during.answered_share() == 1.0, "an answer in every second of the outage");
      }
    }
    if (&street == &kStreets[0]) {
      must(joint.rmse_m() <= 0.4 * gps.rmse_m(), "joint 60 % below GPS in full view");
      must(tight.rmse_m() <= 0.4 * gps.rmse_m(), "tight 60 % below GPS in full view");
      must(joint_all.rmse_m() <= 0.4 * all.rmse_m(), "joint 60 % below all systems");
    }
  }
  return missed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace lodemark

int main(int argc, char** argv) {
  const int epochs = argc > 1 ? std::atoi(argv[1]) : 1000;
  if (epochs < 8) {
    std::fprintf(stderr, "usage: outage_tables [EPOCHS]\n");
    return 2;
  }
  if (!lodemark::test::HasRecording(lodemark::kRecording)) {
    std::fprintf(stderr, "outage_tables: no recording %s\n", lodemark::kRecording);
    return 77;
  }
  return lodemark::Main(static_cast<std::size_t>(epochs));
}
