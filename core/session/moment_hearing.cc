#include "core/session/moment_hearing.h"

#include "core/base/units.h"

namespace lodemark {
namespace {

void NoteInertial(const EpochFilter& filter, SessionEstimate* estimate) {
  if (filter.inertial() && estimate->status == EstimateStatus::kFix) {
    estimate->sources |= kSourceInertial;
    estimate->attitude = filter.AttitudeAt(estimate->time_ns);
  }
}

}  // namespace

// Only photographs come late.
bool MomentHearing::RemembersMoments() const {
  return options_.estimator != Estimator::kEpoch && options_.scheme != Scheme::kGnss &&
         photos_->has_map();
}

void MomentHearing::Save(std::int64_t time_ns, std::int64_t time_gps_ns,
                         RecentMoment* moment) const {
  moment->time_ns = time_ns;
  moment->time_gps_ns = time_gps_ns;
  solver_->Save(&moment->solver);
  moment->photos = photos_->memory();
}

// Where memory ran out on the way, what is remembered no longer fits what is known.
void MomentHearing::Begin() {
  if (begun_) Forget();
  begun_ = true;
}

void MomentHearing::HearEpoch(std::int64_t time_ns, const ObservationEpoch& epoch,
                              HeardMoment* heard) {
  if (RemembersMoments()) {
    if (recent_.IsTooLate(time_ns)) recent_.Forget();
    RecentMoment* moment = recent_.Spare();
    const std::size_t place = GoBackTo(time_ns);  // a photograph may have come before it
    moment->is_photo = false;
    moment->epoch = epoch;
    moment->sighting.reset();
    Save(time_ns, heard->estimate.time_gps_ns, moment);
    present_ = recent_.Keep(place);
  }
  Play(time_ns, epoch, heard);
}

std::size_t MomentHearing::GoBackTo(std::int64_t time_ns) {
  const std::size_t place = recent_.CountBefore(time_ns);
  if (place < recent_.count()) {
    solver_->GoBackTo(recent_[place].solver);
    photos_->GoBackTo(recent_[place].photos);
  }
  return place;
}

void MomentHearing::Play(std::int64_t time_ns, const ObservationEpoch& epoch, HeardMoment* heard) {
  if (epoch.clock_discontinuity) solver_->ForgetRanges();
  solver_->UseSights(photos_->SightsAt(time_ns, epoch.time_gps_ns, events_));
  const PhotoPart& photo = photos_->PartForEpoch(time_ns);
  solver_->Solve(epoch, photo, &heard->estimate, &heard->satellites);
  photos_->Judge(*solver_, &heard->estimate, &heard->landmarks);
  photos_->NoteEpoch(epoch.time_gps_ns, heard->estimate);
  if (heard->estimate.status != EstimateStatus::kFix) return;
  // The repair moved tag and ranges alike; the clock is told against the tag as received.
  const std::int64_t moved_ns = heard->estimate.time_gps_ns - epoch.time_gps_ns;
  heard->estimate.clock_bias_m += kSpeedOfLight_mps * 1e-9 * static_cast<double>(moved_ns);
}

bool MomentHearing::HearPhoto(HeardMoment* heard) {
  const std::int64_t time_ns = photos_->next_time_ns();
  if (!RemembersMoments()) {
    photos_->Hold(*sensors_, solver_->filter().AttitudeAt(time_ns));
    photos_->Look(solver_, &heard->estimate, &heard->landmarks, events_);
    return true;
  }
  if (recent_.IsTooLate(time_ns)) {
    photos_->SetTime(time_ns, &heard->estimate);
    events_->SetTime(time_ns, heard->estimate.time_gps_ns);
    events_->NotePhotoTooLate(recent_.LateBy(time_ns));
    photos_->Drop();
    return false;
  }
  RecentMoment* moment = recent_.Spare();
  const std::size_t place = GoBackTo(time_ns);
  moment->is_photo = true;
  moment->sighting.reset();
  Save(time_ns, 0, moment);
  present_ = recent_.Keep(place);
  photos_->Hold(*sensors_, solver_->filter().AttitudeAt(time_ns));
  photos_->Look(solver_, &heard->estimate, &heard->landmarks, events_);
  moment->sighting = photos_->sighting();
  return true;
}

void MomentHearing::Finish(HeardMoment* heard) {
  NoteInertial(solver_->filter(), &heard->estimate);
  const std::size_t in_way = options_.estimator == Estimator::kSmoother
                                 ? way_->Note(heard->estimate, solver_->filter())
                                 : 0;
  if (present_) {
    recent_[*present_].in_way = in_way;
    recent_[*present_].satellites_seen = heard->estimate.satellites_seen;
    for (std::size_t i = *present_ + 1; i < recent_.count(); ++i) HearAgain(&recent_[i]);
  }
  present_.reset();
  begun_ = false;
}

// What is said of it stays said; only what comes later hears of it, and what is smoothed.
void MomentHearing::HearAgain(RecentMoment* moment) {
  Save(moment->time_ns, moment->time_gps_ns, moment);
  again_.estimate = SessionEstimate();
  again_.satellites.clear();
  again_.landmarks.clear();
  if (moment->is_photo) {
    photos_->TakeAgain(moment->time_ns, moment->sighting, solver_, &again_.estimate,
                       &again_.landmarks);
  } else {
    again_.estimate.time_ns = moment->time_ns;
    again_.estimate.time_gps_ns = moment->time_gps_ns;
    Play(moment->time_ns, moment->epoch, &again_);
    again_.estimate.satellites_seen = moment->satellites_seen;
  }
  NoteInertial(solver_->filter(), &again_.estimate);
  if (options_.estimator != Estimator::kSmoother) return;
  way_->NoteAgain(moment->in_way, again_.estimate, solver_->filter());
}

void MomentHearing::Forget() {
  recent_.Forget();
  present_.reset();
}

}  // namespace lodemark
