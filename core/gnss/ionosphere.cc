#include "core/gnss/ionosphere.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

// Effective ionisation whose NTCM-G is the mean over a solar cycle, in solar flux units; near the
// mean of F10.7 over cycles 19 to 24.
constexpr GalileoIonosphereParameters kMeanSun = {{110.0, 0.0, 0.0}, 0};

constexpr double kGpsL1_hz = 1575.42e6;

// What a model leaves, as a share of the delay: Klobuchar removes half (IS-GPS-200N
// 20.3.3.5.2.5), NTCM-G about 70 % (Hoque, Jakowski and Orus-Perez 2019), BDGIM 78 % (Yuan et al.
// 2019). With no coefficients at all the sun's activity is unknown to a factor of two.
struct Leftover {
  double share = 0.0;
  double least_zenith_m = 0.0;  // on L1
};

Leftover LeftoverOf(IonosphereModel::Kind kind) {
  using Kind = IonosphereModel::Kind;
  switch (kind) {
    case Kind::kBdgim:
      return {0.25, 0.5};
    case Kind::kNtcmG:
      return {0.30, 0.5};
    case Kind::kKlobuchar:
      return {0.50, 0.7};
    case Kind::kClimatology:
      return {0.60, 1.0};
    case Kind::kNone:
      break;
  }
  return {0.0, 5.0};
}

// Thin shell 350 km above a sphere.
double Obliquity(double elevation_rad) {
  const double sin_zenith = 6371.0 / (6371.0 + 350.0) * std::cos(std::max(elevation_rad, 0.0));
  return 1.0 / std::sqrt(1.0 - sin_zenith * sin_zenith);
}

template <std::size_t kSize>
bool IsMeaningful(const std::array<double, kSize>& values) {
  bool any = false;
  for (const double value : values) {
    if (!std::isfinite(value)) return false;
    any = any || value != 0.0;
  }
  return any;
}

}  // namespace

void IonosphereModel::Add(const IonosphereMessage& message) {
  if (const auto* klobuchar = std::get_if<KlobucharParameters>(&message.model)) {
    if (!IsMeaningful(klobuchar->alpha) || !IsMeaningful(klobuchar->beta)) return;
    if (klobuchar->system == System::kGps) {
      gps_klobuchar_ = *klobuchar;
    } else if (klobuchar->system == System::kBeidou) {
      beidou_klobuchar_ = *klobuchar;
    } else {
      regional_klobuchar_ = *klobuchar;
    }
  } else if (const auto* galileo = std::get_if<GalileoIonosphereParameters>(&message.model)) {
    if (IsMeaningful(galileo->a)) galileo_ = *galileo;
  } else if (const auto* bdgim = std::get_if<BdgimParameters>(&message.model)) {
    if (IsMeaningful(bdgim->alpha)) bdgim_ = *bdgim;
  }
}

const KlobucharParameters* IonosphereModel::Klobuchar() const {
  if (gps_klobuchar_) return &*gps_klobuchar_;
  if (beidou_klobuchar_) return &*beidou_klobuchar_;
  if (regional_klobuchar_) return &*regional_klobuchar_;
  return nullptr;
}

bool IonosphereModel::Has(Kind kind) const {
  switch (kind) {
    case Kind::kBdgim:
      return bdgim_.has_value();
    case Kind::kNtcmG:
      return galileo_.has_value();
    case Kind::kKlobuchar:
      return Klobuchar() != nullptr;
    case Kind::kNone:
    case Kind::kClimatology:
      return true;
  }
  return false;
}

IonosphereModel::Kind IonosphereModel::Best() const {
  for (const Kind kind : {Kind::kBdgim, Kind::kNtcmG, Kind::kKlobuchar}) {
    if (Has(kind)) return kind;
  }
  return Kind::kClimatology;
}

const NtcmGSeason& IonosphereModel::SeasonAt(std::int64_t time_gps_ns) const {
  if (time_gps_ns >= ntcm_season_until_gps_ns_ ||
      time_gps_ns < ntcm_season_until_gps_ns_ - kDay_ns) {
    ntcm_season_ = SeasonOfNtcmG(time_gps_ns);
    ntcm_season_until_gps_ns_ = GpsFromScale((ntcm_season_.day + 1) * kDay_ns, TimeScale::kUtc);
  }
  return ntcm_season_;
}

double IonosphereModel::Delay(const Geodetic& receiver, const Eigen::Vector3d&,
                              const Eigen::Vector3d&, const LookAngles& satellite,
                              std::int64_t time_gps_ns, double frequency_hz, double* sigma_m,
                              std::optional<Kind> wanted) const {
  Kind kind = wanted.value_or(Best());
  if (!Has(kind)) kind = Kind::kClimatology;
  double delay_m = 0.0;
  switch (kind) {
    case Kind::kNone:
      break;
    case Kind::kKlobuchar:
      delay_m = KlobucharDelay(*Klobuchar(), receiver, satellite, time_gps_ns, frequency_hz);
      break;
    case Kind::kBdgim:
      if (bdgim_prediction_.slot != BdgimSlot(time_gps_ns)) {
        bdgim_prediction_ = PredictBdgim(time_gps_ns);
      }
      delay_m =
          BdgimDelay(*bdgim_, bdgim_prediction_, receiver, satellite, time_gps_ns, frequency_hz);
      break;
    case Kind::kNtcmG:
      delay_m = NtcmGDelay(*galileo_, SeasonAt(time_gps_ns), receiver, satellite, time_gps_ns,
                           frequency_hz);
      break;
    case Kind::kClimatology:
      delay_m = NtcmGDelay(kMeanSun, SeasonAt(time_gps_ns), receiver, satellite, time_gps_ns,
                           frequency_hz);
      break;
  }
  if (sigma_m != nullptr) {
    const Leftover leftover = LeftoverOf(kind);
    const double ratio = kGpsL1_hz / frequency_hz;
    *sigma_m = std::max(leftover.share * delay_m, leftover.least_zenith_m * ratio * ratio *
                                                      Obliquity(satellite.elevation_rad));
  }
  return delay_m;
}

}  // namespace lodemark
