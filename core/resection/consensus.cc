#include "core/resection/consensus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/resection/minimal_solvers.h"
#include "core/resection/pose_scoring.h"
#include "core/resection/sample_gate.h"

namespace lodemark {
namespace {

// Beyond this sigma, the lean that two sights take over from gravity hides which others agree.
constexpr double kSurestGravity_rad = 0.05;

// Of samples without a mistaken sight, the share whose pose is near enough to the truth for the
// others to agree.
constexpr double kFortunate = 0.7;

// How often each possible sample may come up before the search has seen enough of few sights.
constexpr double kRepeats = 12.0;

// Until so many samples were drawn, every second one is from the surest sights only.
constexpr double kSurestFirst = 1000.0;

// Share of the best pose's merit (squared misfit saved against no pose at all) that makes a rival.
constexpr double kRivalMerit = 0.5;

constexpr std::size_t kMostInSearch = 256;  // sights a candidate is improved on
constexpr std::size_t kMostAtTheEnd = 2000;

double Combinations(std::size_t of, int taken) {
  double count = 1.0;
  for (int k = 0; k < taken; ++k) count *= (static_cast<double>(of) - k) / (k + 1);
  return std::max(count, 0.0);
}

class Search {
 public:
  Search(const SightTable& table, const ResectionPriors& priors, const ConsensusOptions& options)
      : table_(table),
        priors_(priors),
        options_(options),
        gate_(table, priors),
        random_(options.seed),
        drawn_(priors.gravity && priors.gravity->sigma_rad < kSurestGravity_rad ? 2 : 3),
        no_merit_(options.threshold * options.threshold * static_cast<double>(table.size())) {
    // Where two sights lean with gravity, others agree only within what that is worth.
    if (drawn_ == 2) {
      const double lean = table.typical_scale() * priors.gravity->sigma_rad;
      wide_threshold_ = std::min(std::hypot(options.threshold, lean), 6.0 * options.threshold);
    } else {
      wide_threshold_ = options.threshold;
    }
    for (const std::size_t row : table.by_quality()) {
      if (gate_.AdmitsSight(row)) rows_.push_back(row);
    }
  }

  Consensus Run() {
    Consensus found;
    found.sights_per_sample = drawn_;
    const std::size_t drawn = static_cast<std::size_t>(drawn_);
    if (rows_.size() <= drawn) return found;
    const double enough = kRepeats * Combinations(rows_.size(), drawn_) + 50.0;
    wanted_ = std::min(static_cast<double>(options_.most_samples), enough);
    while (static_cast<double>(samples_) < wanted_) {
      ++samples_;
      if (samples_ % 256 == 1) SetTest();
      Draw();
      Try();
    }
    found.samples = static_cast<int>(samples_);
    if (!best_) return found;
    found.best = Improved(best_->camera_from_world, options_.threshold, kMostAtTheEnd, *best_);
    if (rival_ && IsElsewhere(rival_->camera_from_world, *found.best)) found.rival = rival_;
    return found;
  }

 private:
  // Fills sample_ with different rows.
  void Draw() {
    std::size_t pool = rows_.size();
    const double progress = static_cast<double>(samples_) / kSurestFirst;
    if (table_.has_qualities() && progress < 1.0 && samples_ % 2 == 0) {
      const double share = std::pow(progress, 1.0 / drawn_);
      const std::size_t least = std::min<std::size_t>(rows_.size(), 8);
      pool = std::clamp(static_cast<std::size_t>(share * static_cast<double>(rows_.size())), least,
                        rows_.size());
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(drawn_); ++k) {
      bool is_new = false;
      while (!is_new) {
        sample_[k] = rows_[random_.Index(pool)];
        is_new = std::find(sample_.begin(), sample_.begin() + static_cast<std::ptrdiff_t>(k),
                           sample_[k]) == sample_.begin() + static_cast<std::ptrdiff_t>(k);
      }
    }
  }

  void Try() {
    if (!gate_.AdmitsPair(sample_[0], sample_[1])) return;
    if (drawn_ == 2) {
      const PoseSet<2> poses =
          PoseFromTwoPointsAndGravity({table_.bearing(sample_[0]), table_.bearing(sample_[1])},
                                      {table_.landmark(sample_[0]), table_.landmark(sample_[1])},
                                      priors_.gravity->up_in_camera, Eigen::Vector3d::UnitZ());
      for (const Rigid3& pose : poses) Weigh(pose);
      return;
    }
    if (!gate_.AdmitsPair(sample_[0], sample_[2]) || !gate_.AdmitsPair(sample_[1], sample_[2])) {
      return;
    }
    const PoseSet<4> poses = PoseFromThreePoints(
        {table_.bearing(sample_[0]), table_.bearing(sample_[1]), table_.bearing(sample_[2])},
        {table_.landmark(sample_[0]), table_.landmark(sample_[1]), table_.landmark(sample_[2])});
    for (const Rigid3& pose : poses) Weigh(pose);
  }

  void Weigh(const Rigid3& pose) {
    if (!gate_.AdmitsPose(pose)) return;
    const PoseScore score = ScorePose(table_, pose, wide_threshold_, test_, most_wide_cost_);
    if (!score.is_complete) {
      // What poses agree with that are given up, to tell the good ones from.
      stray_seen_ += static_cast<double>(score.seen);
      stray_agreeing_ += static_cast<double>(score.agreeing);
      return;
    }
    const bool is_best = score.cost < least_wide_cost_;
    if (!is_best &&
        !(best_ && IsElsewhere(pose, *best_) && !(rival_ && !IsElsewhere(pose, *rival_)))) {
      return;
    }
    if (is_best) {
      least_wide_cost_ = score.cost;
      const double none = wide_threshold_ * wide_threshold_ * static_cast<double>(table_.size());
      most_wide_cost_ = none - kRivalMerit * (none - least_wide_cost_);
    }
    const ConsensusPose raw = {pose, no_merit_, 0};
    const ConsensusPose improved = Improved(pose, wide_threshold_, kMostInSearch, raw);
    if (improved.agreeing <= static_cast<std::size_t>(drawn_)) return;
    Adopt(improved);
  }

  // The better of fallback and what the pose improves to, by the narrow threshold.
  ConsensusPose Improved(const Rigid3& pose, double wide, std::size_t most_sights,
                         const ConsensusPose& fallback) const {
    ConsensusPose improved;
    improved.camera_from_world =
        ImprovePose(table_, pose, 1.5 * wide, options_.threshold, priors_, most_sights);
    const PoseScore score = ScorePose(table_, improved.camera_from_world, options_.threshold,
                                      SequentialTest(), std::numeric_limits<double>::infinity());
    improved.cost = score.cost;
    improved.agreeing = score.agreeing;
    return improved.cost < fallback.cost ? improved : fallback;
  }

  void Adopt(const ConsensusPose& pose) {
    if (!best_ || pose.cost < best_->cost) {
      if (best_ && IsElsewhere(best_->camera_from_world, pose)) KeepRival(*best_);
      best_ = pose;
      if (rival_ && !IsElsewhere(rival_->camera_from_world, pose)) rival_.reset();
      SetTest();
      SetWanted();
    } else if (IsElsewhere(pose.camera_from_world, *best_)) {
      KeepRival(pose);
    }
  }

  void KeepRival(const ConsensusPose& pose) {
    if (!rival_ || pose.cost < rival_->cost) rival_ = pose;
  }

  // Whether a pose shows the landmarks that agree with another one at other pixels.
  bool IsElsewhere(const Rigid3& pose, const ConsensusPose& other) const {
    constexpr int kLooked = 24;
    const double limit = 9.0 * options_.threshold * options_.threshold;
    int looked = 0;
    int moved = 0;
    for (std::size_t row = 0; row < table_.size() && looked < kLooked; ++row) {
      const Eigen::Vector3d there = other.camera_from_world * table_.landmark(row);
      const double along_m = table_.bearing(row).dot(there);
      if (!(along_m > 0.0)) continue;
      const double square = (table_.tangent(row) * there / along_m).squaredNorm();
      if (!(square < options_.threshold * options_.threshold)) continue;
      ++looked;
      const Eigen::Vector3d here = pose * table_.landmark(row);
      const double here_m = table_.bearing(row).dot(here);
      const double stray = (table_.tangent(row) * here / here_m).squaredNorm();
      if (!(here_m > 0.0) || !(stray < limit)) ++moved;
    }
    return 2 * moved > looked || IsTurned(pose, other.camera_from_world);
  }

  // Two answers of one plane show it at the same pixels, but lean apart.
  static bool IsTurned(const Rigid3& a, const Rigid3& b) {
    return a.rotation().angularDistance(b.rotation()) > 0.1;
  }

  void SetTest() {
    // Before a pose is known: the share that would long have been found were it larger.
    const double expected =
        std::clamp(std::pow(static_cast<double>(samples_), -1.0 / drawn_), 0.01, 0.1);
    const double agreeing = best_ ? static_cast<double>(best_->agreeing) : 0.0;
    const double share = agreeing / static_cast<double>(table_.size());
    const double stray = (stray_agreeing_ + 1.0) / (stray_seen_ + 200.0);
    test_ = SequentialTest(std::max(expected, share), stray);
  }

  void SetWanted() {
    std::size_t agreeing = 0;
    for (const std::size_t row : rows_) {
      const Eigen::Vector3d there = best_->camera_from_world * table_.landmark(row);
      const double along_m = table_.bearing(row).dot(there);
      const double square =
          (table_.tangent(row) * there).squaredNorm() / (along_m * along_m + table_.spread_m2(row));
      if (along_m > 0.0 && square < options_.threshold * options_.threshold) ++agreeing;
    }
    const double share = static_cast<double>(agreeing) / static_cast<double>(rows_.size());
    const double success =
        std::pow(share, drawn_) * kFortunate * (1.0 - SequentialTest::kFalseAlarms);
    if (!(success > 0.0)) return;
    const double missing = std::log(std::max(1.0 - options_.wanted_confidence, 1e-12));
    wanted_ = std::min(wanted_, std::ceil(missing / std::log1p(-success)));
  }

  const SightTable& table_;
  const ResectionPriors& priors_;
  const ConsensusOptions& options_;
  SampleGate gate_;
  Random random_;
  int drawn_;
  double no_merit_;
  double wide_threshold_ = 0.0;
  std::vector<std::size_t> rows_;  // that are drawn from, the surest first
  std::array<std::size_t, 3> sample_ = {};
  std::int64_t samples_ = 0;
  double wanted_ = 0.0;
  SequentialTest test_;
  double stray_seen_ = 0.0;
  double stray_agreeing_ = 0.0;
  double least_wide_cost_ = std::numeric_limits<double>::infinity();
  double most_wide_cost_ = std::numeric_limits<double>::infinity();
  std::optional<ConsensusPose> best_;
  std::optional<ConsensusPose> rival_;
};

}  // namespace

Consensus FindConsensus(const SightTable& table, const ResectionPriors& priors,
                        const ConsensusOptions& options) {
  return Search(table, priors, options).Run();
}

}  // namespace lodemark
