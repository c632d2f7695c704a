// Opening and closing sessions, and running them.
#include "core/session/session.h"

#include <memory>
#include <utility>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/capi/guard.h"
#include "core/capi/session_handle.h"
#include "core/capi/structs.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_TIME_BASE_GPS == 0 && LODEMARK_TIME_BASE_BOOT == 1);
static_assert(LODEMARK_IONOSPHERE_BEST == static_cast<int>(IonosphereChoice::kBest));
static_assert(LODEMARK_IONOSPHERE_NONE == static_cast<int>(IonosphereChoice::kNone));
static_assert(LODEMARK_IONOSPHERE_KLOBUCHAR == static_cast<int>(IonosphereChoice::kKlobuchar));
static_assert(LODEMARK_IONOSPHERE_BDGIM == static_cast<int>(IonosphereChoice::kBdgim));
static_assert(LODEMARK_IONOSPHERE_NTCM_G == static_cast<int>(IonosphereChoice::kNtcmG));
static_assert(LODEMARK_IONOSPHERE_CLIMATOLOGY == static_cast<int>(IonosphereChoice::kClimatology));
static_assert(LODEMARK_TROPOSPHERE_SAASTAMOINEN ==
              static_cast<int>(TroposphereChoice::kSaastamoinen));
static_assert(LODEMARK_TROPOSPHERE_HOPFIELD == static_cast<int>(TroposphereChoice::kHopfield));
static_assert(LODEMARK_TROPOSPHERE_NONE == static_cast<int>(TroposphereChoice::kNone));
static_assert(LODEMARK_SCHEME_JOINT == static_cast<int>(Scheme::kJoint));
static_assert(LODEMARK_SCHEME_TIGHT == static_cast<int>(Scheme::kTight));
static_assert(LODEMARK_SCHEME_TIGHT_DIAGONAL == static_cast<int>(Scheme::kTightDiagonal));
static_assert(LODEMARK_SCHEME_VISION == static_cast<int>(Scheme::kVision));
static_assert(LODEMARK_SCHEME_GNSS == static_cast<int>(Scheme::kGnss));
static_assert(LODEMARK_ESTIMATOR_EPOCH == static_cast<int>(Estimator::kEpoch));
static_assert(LODEMARK_ESTIMATOR_FILTER == static_cast<int>(Estimator::kFilter));
static_assert(LODEMARK_ESTIMATOR_SMOOTHER == static_cast<int>(Estimator::kSmoother));
static_assert(LODEMARK_WEIGHT_SIGNAL == static_cast<int>(WeightChoice::kSignal));
static_assert(LODEMARK_WEIGHT_ELEVATION == static_cast<int>(WeightChoice::kElevation));

constexpr std::uint32_t kAllSystems = (1u << kSystemCount) - 1;
constexpr std::uint32_t kAllFlags = LODEMARK_SESSION_VARIANCE_COMPONENTS |
                                    LODEMARK_SESSION_ZENITH_DELAY | LODEMARK_SESSION_HEIGHT_MEMORY |
                                    LODEMARK_SESSION_FIXED_BIASES |
                                    LODEMARK_SESSION_ACCEPT_UNHEALTHY;

lodemark_status CheckOptions(const lodemark_session_options& options) {
  Check check({"options"});
  check.Constant(options.time_base, LODEMARK_TIME_BASE_BOOT, "time_base");
  check.Bits(options.systems, kAllSystems, "systems");
  check.Bits(options.flags, kAllFlags, "flags");
  check.Constant(options.ionosphere, LODEMARK_IONOSPHERE_CLIMATOLOGY, "ionosphere");
  check.Constant(options.troposphere, LODEMARK_TROPOSPHERE_NONE, "troposphere");
  check.Constant(options.weight, LODEMARK_WEIGHT_ELEVATION, "weight");
  check.Constant(options.scheme, LODEMARK_SCHEME_GNSS, "scheme");
  check.Constant(options.estimator, LODEMARK_ESTIMATOR_SMOOTHER, "estimator");
  check.Within(options.elevation_mask_deg, -90.0, 90.0, "elevation_mask_deg");
  check.Within(options.smallest_cn0_dbhz, -1000.0, 1000.0, "smallest_cn0_dbhz");
  check.Within(options.elevation_a_m, 0.0, 1e6, "elevation_a_m");
  check.Within(options.elevation_b_m, 0.0, 1e6, "elevation_b_m");
  return check.status();
}

SessionOptions ToSessionOptions(const lodemark_session_options& from) {
  const auto has = [&](std::uint32_t flag) { return (from.flags & flag) != 0; };
  SessionOptions to;
  to.time_base = from.time_base == LODEMARK_TIME_BASE_BOOT ? TimeBase::kBoot : TimeBase::kGps;
  to.scheme = static_cast<Scheme>(from.scheme);
  to.estimator = static_cast<Estimator>(from.estimator);
  if (from.systems != 0) to.systems = from.systems;
  to.ionosphere = static_cast<IonosphereChoice>(from.ionosphere);
  to.troposphere = static_cast<TroposphereChoice>(from.troposphere);
  to.weight = static_cast<WeightChoice>(from.weight);
  if (from.queue_capacity != 0) to.queue_capacity = from.queue_capacity;
  if (from.elevation_mask_deg != 0.0) {
    to.elevation_mask_rad = from.elevation_mask_deg * kRadiansPerDegree;
  }
  if (from.smallest_cn0_dbhz != 0.0) to.smallest_cn0_dbhz = from.smallest_cn0_dbhz;
  if (from.elevation_a_m != 0.0) to.elevation_a_m = from.elevation_a_m;
  if (from.elevation_b_m != 0.0) to.elevation_b_m = from.elevation_b_m;
  to.estimate_variance_components = has(LODEMARK_SESSION_VARIANCE_COMPONENTS);
  to.estimate_zenith_delay = has(LODEMARK_SESSION_ZENITH_DELAY);
  to.height_memory = has(LODEMARK_SESSION_HEIGHT_MEMORY);
  to.learn_biases = !has(LODEMARK_SESSION_FIXED_BIASES);
  to.accept_unhealthy = has(LODEMARK_SESSION_ACCEPT_UNHEALTHY);
  if (from.seed != 0) to.seed = from.seed;
  return to;
}

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_session_open(const lodemark_session_options* options,
                                      lodemark_session** session) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  *session = nullptr;
  return Guard([&] {
    lodemark_session_options stated = {};
    if (options != nullptr) {
      lodemark_status status = ReadStruct(options, {"options"}, &stated);
      if (status == LODEMARK_OK) status = CheckOptions(stated);
      if (status != LODEMARK_OK) return status;
    }
    auto handle = std::make_unique<lodemark_session>();
    const SessionOptions accepted = ToSessionOptions(stated);
    Result<std::unique_ptr<Session>> engine = Session::Open(accepted);
    if (!engine) return Fail(engine.error());
    handle->engine = std::move(engine).value();
    handle->time_base = accepted.time_base;
    *session = handle.release();
    return lodemark_status{LODEMARK_OK};
  });
}

void lodemark_session_close(lodemark_session* session) { delete session; }

lodemark_status lodemark_session_reset(lodemark_session* session) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    session->engine->Reset();
    return lodemark_status{LODEMARK_OK};
  });
}

lodemark_status lodemark_session_process(lodemark_session* session) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&]() -> lodemark_status {
    if (!session->engine->ProcessNext()) return LODEMARK_NOTHING_QUEUED;
    const bool fix = session->engine->estimate().status == EstimateStatus::kFix;
    return fix ? LODEMARK_OK : LODEMARK_NO_POSITION;
  });
}

lodemark_status lodemark_session_clear_events(lodemark_session* session) {
  using namespace lodemark;
  if (session == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "session is NULL");
  return Guard([&] {
    session->engine->ClearEvents();
    return lodemark_status{LODEMARK_OK};
  });
}
