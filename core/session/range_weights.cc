#include "core/session/range_weights.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lodemark {
namespace {
double P(const char* n, double d) { const char* e = std::getenv(n); return e ? std::atof(e) : d; }
struct Pars {
  double a = P("PA", 2.0), b = P("PB", 2.3), e0 = P("PE0", 0.9), prior = P("PPRIOR", 300),
         mid = P("PMID", 16.5), width = P("PWIDTH", 4), l0 = P("PL0", 3), l1 = P("PL1", 1.8), lmax = P("PLMAX", 60),
         kprior = P("PKPRIOR", 5), emin = P("PEMIN", 0.01), emax = P("PEMAX", 0.9), forget = P("PFORGET", 0.995), ks=P("PKS",0.99),
         ref0 = P("PREF0", 30), dis = P("PDIS", 0.4), wide = P("PWIDE", 0.5);
} pars;
}  // namespace

void RangeWeights::NoteStrength(int clock_group, double cn0_dbhz) {
  Group& group = groups_[static_cast<std::size_t>(clock_group)];
  group.strongest_dbhz = std::max(group.strongest_dbhz, cn0_dbhz);
}

RangeErrorModel RangeWeights::ErrorModel(int clock_group, const SignalQuality& quality) const {
  const Group& group = groups_[static_cast<std::size_t>(clock_group)];
  const double cn0_dbhz = quality.cn0_dbhz > 0.0 ? quality.cn0_dbhz : 40.0;
  const double sine = std::max(std::sin(quality.elevation_rad), 0.1);
  const double noise_m = pars.b * std::pow(10.0, (40.0 - cn0_dbhz) / 20.0);
  const double wide = quality.wideband ? pars.wide : 1.0;
  const double noise_variance = wide * wide * (pars.a * pars.a + noise_m * noise_m) * (pars.e0 + (1 - pars.e0) / (sine * sine));
  const double factor = (pars.prior + group.squares) / (pars.prior + group.count);
  RangeErrorModel model;
  model.sigma_m = std::sqrt(factor * noise_variance + quality.model_sigma_m * quality.model_sigma_m + pars.dis * quality.rate_disagreement_m * quality.rate_disagreement_m);
  const double deficit = std::max(0.0, std::max(group.strongest_dbhz, pars.ref0) - cn0_dbhz);
  const double odds = std::exp((deficit - pars.mid) / pars.width) * (pars.kprior + late_found_) / (pars.kprior + late_expected_);
  model.late_probability = std::clamp(odds / (1.0 + odds), pars.emin, pars.emax);
  model.late_scale_m = std::clamp(pars.l0 + pars.l1 * deficit, 8.0, pars.lmax);
  return model;
}

void RangeWeights::Learn(int clock_group, const RangeErrorModel& model, double residual_m,
                         double redundancy_share, double core_share, double late_share) {
  Group& group = groups_[static_cast<std::size_t>(clock_group)];
  const double u = residual_m / model.sigma_m;
  const double factor = (pars.prior + group.squares) / (pars.prior + group.count);
  group.squares += core_share * u * u * factor;
  group.count += core_share * redundancy_share;
  late_found_ += late_share;
  late_expected_ += model.late_probability;
}

void RangeWeights::FinishEpoch() {
  for (Group& group : groups_) {
    group.squares *= pars.forget;
    group.count *= pars.forget;
    group.strongest_dbhz = std::max(0.0, group.strongest_dbhz - 0.02);
  }
  late_found_ *= pars.ks;
  late_expected_ *= pars.ks;
}

void RangeWeights::Forget() { *this = RangeWeights(); }

}  // namespace lodemark
