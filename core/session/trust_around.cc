#include "core/session/trust_around.h"

#include <algorithm>
#include <cmath>

#include "core/session/satellite_trust.h"

namespace lodemark {
namespace {

// How the ranges of one satellite fared, each moment the less the farther away it is in time.
class FadingRecords {
 public:
  void Fade(double seconds) {
    const double left = std::exp(-seconds / kTrustMemory_s);
    for (Record& record : records_) {
      record.heard *= left;
      record.ranges *= left;
    }
    std::erase_if(records_, [](const Record& record) { return record.ranges < 1e-9; });
  }

  void Note(std::span<const RangeSource> sources, std::span<const ObservationVerdict> verdicts) {
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      Record& record = Of(sources[i].satellite);
      record.heard += TrustIn(verdicts[i]);
      record.ranges += 1.0;
    }
  }

  void AddTo(std::span<const SatelliteId> satellites, double* sums) const {
    for (std::size_t i = 0; i < satellites.size(); ++i) {
      for (const Record& record : records_) {
        if (record.satellite != satellites[i]) continue;
        sums[2 * i] += record.heard;
        sums[2 * i + 1] += record.ranges;
      }
    }
  }

 private:
  struct Record {
    SatelliteId satellite;
    double heard = 0.0;
    double ranges = 0.0;
  };

  Record& Of(SatelliteId satellite) {
    for (Record& record : records_) {
      if (record.satellite == satellite) return record;
    }
    return records_.emplace_back(Record{satellite});
  }

  std::vector<Record> records_;
};

// heard and ranges of each rate, then of each change.
using Sums = std::vector<double>;

void AddTo(const HeardStep& moment, const FadingRecords& records, Sums* sums) {
  sums->resize(2 * (moment.rates.size() + moment.changes.size()), 0.0);
  records.AddTo(moment.rate_satellites, sums->data());
  records.AddTo(moment.change_satellites, sums->data() + 2 * moment.rates.size());
}

double FactorOf(const double* sums) {
  return SigmaFactorOfTrust(sums[1] > 0.0 ? sums[0] / sums[1] : kUnknownTrust);
}

}  // namespace

std::vector<MomentSigmaFactors> SigmaFactorsAround(
    std::span<const HeardStep> moments, std::span<const std::vector<ObservationVerdict>> verdicts) {
  const std::size_t count = moments.size();
  const auto seconds_to = [&](std::size_t i) {
    return std::abs(1e-9 * static_cast<double>(moments[i].time_ns - moments[i - 1].time_ns));
  };
  std::vector<Sums> sums(count);
  FadingRecords before;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) before.Fade(seconds_to(i));
    before.Note(moments[i].sources, verdicts[i]);
    AddTo(moments[i], before, &sums[i]);
  }
  FadingRecords after;
  for (std::size_t i = count; i-- > 0;) {
    if (i + 1 < count) after.Fade(seconds_to(i + 1));
    AddTo(moments[i], after, &sums[i]);
    after.Note(moments[i].sources, verdicts[i]);
  }
  std::vector<MomentSigmaFactors> factors(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t rates = moments[i].rates.size();
    for (std::size_t k = 0; 2 * k < sums[i].size(); ++k) {
      (k < rates ? factors[i].rates : factors[i].changes).push_back(FactorOf(&sums[i][2 * k]));
    }
  }
  return factors;
}

}  // namespace lodemark
