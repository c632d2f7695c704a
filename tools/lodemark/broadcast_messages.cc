#include "tools/lodemark/broadcast_messages.h"

#include "core/logs/ubx.h"

namespace lodemark {
namespace {

// A receiver gets some ten a second from all its satellites.
constexpr std::size_t kMostWaitingMessages = 10'000;

}  // namespace

void BroadcastMessages::Add(const LoggedNavigationMessage& message) {
  if (waiting_.size() < kMostWaitingMessages) waiting_.push_back(message);
}

void BroadcastMessages::Add(const ObservationEpoch& epoch) {
  for (const SignalObservation& signal : epoch.signals) {
    if (signal.glonass_channel == kUnknownGlonassChannel) continue;
    glonass_channels_[signal.satellite.number] = signal.glonass_channel;
  }
  last_gps_ns_ = epoch.time_gps_ns;
  Decode(epoch.time_gps_ns);
}

void BroadcastMessages::Finish() {
  if (last_gps_ns_ > 0) Decode(last_gps_ns_);
}

void BroadcastMessages::Decode(std::int64_t received_gps_ns) {
  std::size_t known = records_.size();
  for (const LoggedNavigationMessage& message : waiting_) {
    decoder_.Push(message.type, message.svid, message.bytes, received_gps_ns, &records_);
  }
  waiting_.clear();
  for (; known < records_.size(); ++known) {
    auto* state = std::get_if<StateEphemeris>(&records_[known]);
    if (state == nullptr || state->glonass_channel != kUnknownGlonassChannel) continue;
    const auto channel = glonass_channels_.find(state->satellite.number);
    if (channel != glonass_channels_.end()) state->glonass_channel = channel->second;
  }
}

Result<std::vector<NavigationRecord>> ReadUbxBroadcast(const std::string& path) {
  Result<UbxReader> reader = UbxReader::Open(path);
  if (!reader) return reader.error();
  BroadcastMessages messages;
  UbxRecord record;
  while (reader->Next(&record)) {
    if (const auto* epoch = std::get_if<ObservationEpoch>(&record)) {
      messages.Add(*epoch);
    } else if (const auto* message = std::get_if<LoggedNavigationMessage>(&record)) {
      messages.Add(*message);
    }
  }
  // A file that ends early still has the orbits before; its measurements tell of the end.
  messages.Finish();
  return std::vector<NavigationRecord>(messages.records().begin(), messages.records().end());
}

}  // namespace lodemark
