// Ionospheric delay from broadcast and climatological models.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/geo/geodetic.h"
#include "core/gnss/ephemeris.h"

namespace lodemark {

// Klobuchar's model (IS-GPS-200N 20.3.3.5.2.5). BeiDou's D1/D2 variant (BDS-SIS-ICD-B1I 3.0
// 5.2.4.7) where parameters.system is BeiDou. Delay in metres on the given carrier, never negative.
double KlobucharDelay(const KlobucharParameters& parameters, const Geodetic& receiver,
                      const LookAngles& satellite, std::int64_t time_gps_ns, double frequency_hz);

// The part of BeiDou's global model that is not broadcast, but predicted from a table of periods:
// coefficients in TECu for two hours.
struct BdgimPrediction {
  std::int64_t slot = -1;  // two-hour intervals of BeiDou time since 1980-01-06
  std::array<double, 17> beta = {};
};

BdgimPrediction PredictBdgim(std::int64_t time_gps_ns);
// The slot of PredictBdgim(time_gps_ns), to see whether a prediction still holds.
std::int64_t BdgimSlot(std::int64_t time_gps_ns);

// BeiDou global model (BDS-SIS-ICD-B1C 1.0 section 7.8). Never negative.
double BdgimDelay(const BdgimParameters& parameters, const BdgimPrediction& prediction,
                  const Geodetic& receiver, const LookAngles& satellite, std::int64_t time_gps_ns,
                  double frequency_hz);

// What of NTCM-G is the same for a whole day of UTC.
struct NtcmGSeason {
  std::int64_t day = -1;  // of UTC since 1980-01-06
  double cos_declination = 1.0;
  double sin_declination = 0.0;
  double factor = 1.0;
};

NtcmGSeason SeasonOfNtcmG(std::int64_t time_gps_ns);

// NTCM-G driven by Galileo's coefficients (European Commission, NTCM-G Ionospheric Model
// Description, issue 1.0, 2022). Never negative. season is that of the time.
double NtcmGDelay(const GalileoIonosphereParameters& parameters, const NtcmGSeason& season,
                  const Geodetic& receiver, const LookAngles& satellite, std::int64_t time_gps_ns,
                  double frequency_hz);

// The best of what was received, and a climatological default when nothing was: NTCM-G at a solar
// flux that is the mean over a solar cycle. One session's object: Delay keeps what it computes for
// two hours or a day at a time, so it is not to be shared between threads.
class IonosphereModel {
 public:
  enum class Kind : std::uint8_t { kNone, kKlobuchar, kBdgim, kNtcmG, kClimatology };

  // The last message of each model counts. Ignores coefficients that are not finite or, as before
  // the first upload, all zero; Klobuchar's of a regional system only stand in for those of GPS.
  void Add(const IonosphereMessage& message);

  // Which model Delay uses unless told otherwise: BDGIM, NTCM-G, Klobuchar, climatology, in the
  // order of what they leave (Yuan et al. 2019; Hoque et al. 2019).
  Kind Best() const;

  // Delay in metres on the carrier, and its 1 sigma in metres through sigma_m if not null. The
  // climatology stands in for a kind of which nothing was received; kNone gives 0.
  double Delay(const Geodetic& receiver, const Eigen::Vector3d& receiver_in_ecef,
               const Eigen::Vector3d& satellite_in_ecef, const LookAngles& satellite,
               std::int64_t time_gps_ns, double frequency_hz, double* sigma_m,
               std::optional<Kind> kind = std::nullopt) const;

 private:
  bool Has(Kind kind) const;
  const KlobucharParameters* Klobuchar() const;

  std::optional<KlobucharParameters> gps_klobuchar_;
  std::optional<KlobucharParameters> beidou_klobuchar_;
  std::optional<KlobucharParameters> regional_klobuchar_;  // QZSS, NavIC
  std::optional<GalileoIonosphereParameters> galileo_;
  std::optional<BdgimParameters> bdgim_;
  const NtcmGSeason& SeasonAt(std::int64_t time_gps_ns) const;

  mutable BdgimPrediction bdgim_prediction_;
  mutable NtcmGSeason ntcm_season_;
  mutable std::int64_t ntcm_season_until_gps_ns_ = 0;  // from a day before
};

}  // namespace lodemark
