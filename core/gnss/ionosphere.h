// Ionospheric delay from broadcast and climatological models.
#pragma once

#include <cstdint>
#include <optional>

#include "core/geo/geodetic.h"
#include "core/gnss/ephemeris.h"

namespace lodemark {

// Klobuchar's model (IS-GPS-200N 20.3.3.5.2.5; BeiDou D1/D2 has its own variant, chosen by
// parameters.system). Delay in metres on the given carrier, never negative.
double KlobucharDelay(const KlobucharParameters& parameters, const Geodetic& receiver,
                      const LookAngles& satellite, std::int64_t time_gps_ns, double frequency_hz);

// BeiDou global model (BDS-SIS-ICD-B1C 1.0 section 7.8).
double BdgimDelay(const BdgimParameters& parameters, const Geodetic& receiver,
                  const Eigen::Vector3d& receiver_in_ecef, const Eigen::Vector3d& satellite_in_ecef,
                  std::int64_t time_gps_ns, double frequency_hz);

// NTCM-G driven by Galileo's coefficients (European Commission, NTCM-G Ionospheric Model
// Description, issue 1.0).
double NtcmGDelay(const GalileoIonosphereParameters& parameters, const Geodetic& receiver,
                  const Eigen::Vector3d& receiver_in_ecef, const Eigen::Vector3d& satellite_in_ecef,
                  std::int64_t time_gps_ns, double frequency_hz);

// The best of what was received, and a climatological default when nothing was.
class IonosphereModel {
 public:
  enum class Kind : std::uint8_t { kNone, kKlobuchar, kBdgim, kNtcmG, kClimatology };

  void Add(const IonosphereMessage& message);

  // Which model Delay uses unless told otherwise.
  Kind Best() const;

  // Delay in metres on the carrier, and its 1 sigma in metres through sigma_m if not null.
  double Delay(const Geodetic& receiver, const Eigen::Vector3d& receiver_in_ecef,
               const Eigen::Vector3d& satellite_in_ecef, const LookAngles& satellite,
               std::int64_t time_gps_ns, double frequency_hz, double* sigma_m,
               std::optional<Kind> kind = std::nullopt) const;

 private:
  std::optional<KlobucharParameters> gps_klobuchar_;
  std::optional<KlobucharParameters> beidou_klobuchar_;
  std::optional<GalileoIonosphereParameters> galileo_;
  std::optional<BdgimParameters> bdgim_;
};

}  // namespace lodemark
