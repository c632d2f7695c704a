// A drive under the invented sky, with carrier phase and noise, for the tests of the filter.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/random.h"
#include "test/unit/session/session_scene.h"

namespace lodemark::test {

struct FilterNoise {
  double code_m = 4.0;
  double rate_mps = 0.05;
  double phase_m = 0.004;
};

class FilterScene {
 public:
  explicit FilterScene(const Eigen::Vector3d& velocity_enu_mps) {
    scene.velocity_enu_mps = velocity_enu_mps;
    scene.options.estimator = Estimator::kFilter;
  }

  // An epoch a second, measured with noise of its own each.
  std::vector<ObservationEpoch> Drive(int epochs, std::uint64_t seed = 4,
                                      const FilterNoise& noise = {}) const {
    Random random(seed);
    std::vector<ObservationEpoch> drive;
    for (int i = 0; i < epochs; ++i) {
      ObservationEpoch epoch = scene.Epoch(i);
      for (SignalObservation& signal : epoch.signals) {
        const double wavelength_m = kSpeedOfLight_mps / signal.frequency_hz;
        signal.present |= kHasCarrierPhase;
        // Of an origin of its own.
        signal.carrier_phase_cycles =
            (signal.pseudorange_m + random.Gaussian(0.0, noise.phase_m)) / wavelength_m -
            1e5 * signal.satellite.number;
        signal.pseudorange_m += random.Gaussian(0.0, noise.code_m);
        signal.doppler_hz += random.Gaussian(0.0, noise.rate_mps) / wavelength_m;
      }
      drive.push_back(epoch);
    }
    return drive;
  }

  Eigen::Vector3d ErrorEnu(const SessionEstimate& estimate, int epoch) const {
    return EnuFromEcefRotation(scene.place) * (estimate.position_in_ecef - scene.PlaceAt(epoch));
  }
  double HorizontalError(const SessionEstimate& estimate, int epoch) const {
    return ErrorEnu(estimate, epoch).head<2>().norm();
  }

  std::vector<SessionEstimate> Run(const std::vector<ObservationEpoch>& drive) const {
    const std::unique_ptr<Session> session = scene.Open();
    return Run(session.get(), drive);
  }
  static std::vector<SessionEstimate> Run(Session* session,
                                          const std::vector<ObservationEpoch>& drive) {
    std::vector<SessionEstimate> estimates;
    for (const ObservationEpoch& epoch : drive) estimates.push_back(ProcessEpoch(session, epoch));
    return estimates;
  }

  SessionScene scene;
};

}  // namespace lodemark::test
