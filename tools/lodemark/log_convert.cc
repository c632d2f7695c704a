// lodemark log convert: GnssLogger text, u-blox files and RINEX of any version to RINEX 3.04. The
// satellites' messages that a log holds become a navigation file beside the observations.
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "core/gnss/android_observables.h"
#include "core/logs/gnss_logger.h"
#include "core/logs/recording.h"
#include "core/logs/rinex_navigation.h"
#include "core/logs/rinex_navigation_writer.h"
#include "core/logs/rinex_observation.h"
#include "core/logs/rinex_observation_writer.h"
#include "core/logs/ubx.h"
#include "tools/lodemark/broadcast_messages.h"
#include "tools/lodemark/command.h"
#include "tools/lodemark/log_commands.h"
#include "tools/lodemark/output_file.h"
#include "tools/lodemark/progress_bar.h"

namespace lodemark {
namespace {

namespace fs = std::filesystem;

CalendarTime Now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm utc = {};
  gmtime_r(&seconds, &utc);
  return {utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
          utc.tm_hour,        utc.tm_min,     static_cast<double>(utc.tm_sec)};
}

// The name without folder, ".gz" and the last extension, in the output folder.
std::string OutputPath(const std::string& folder, const std::string& input, const char* extension) {
  fs::path name = fs::path(input).filename();
  if (name.extension() == ".gz" || name.extension() == ".GZ") name = name.stem();
  return (fs::path(folder) / name.stem()).string() + extension;
}

// Writing over a file that is being read would destroy it.
Status CheckNotTheInput(const std::string& input, const std::string& output) {
  std::error_code ignored;
  if (!fs::equivalent(input, output, ignored)) return {};
  return Error{ErrorCode::kInvalidArgument,
               output + ": is the file to convert; name another folder with --out"};
}

// Reads epochs one by one out of whatever the file is.
class EpochSource {
 public:
  virtual ~EpochSource() = default;
  virtual bool Next(ObservationEpoch* epoch) = 0;
  virtual Status status() const = 0;
  virtual double progress() const = 0;
  virtual RinexObservationHeader header() const = 0;
  // What the satellites' messages between the epochs so far amount to.
  virtual std::span<const NavigationRecord> navigation() const { return {}; }
};

class LoggerSource : public EpochSource {
 public:
  explicit LoggerSource(GnssLoggerReader reader) : reader_(std::move(reader)) {}

  bool Next(ObservationEpoch* epoch) override {
    while (reader_.Next(&record_)) {
      const auto* message = std::get_if<LoggedNavigationMessage>(&record_);
      if (message != nullptr) messages_.Add(*message);
      const auto* raw = std::get_if<AndroidEpoch>(&record_);
      if (raw == nullptr || !observables_.Convert(*raw, epoch, &outcomes_)) continue;
      messages_.Add(*epoch);
      return true;
    }
    messages_.Finish();
    return false;
  }
  std::span<const NavigationRecord> navigation() const override { return messages_.records(); }
  Status status() const override { return reader_.status(); }
  double progress() const override { return reader_.progress(); }
  RinexObservationHeader header() const override {
    RinexObservationHeader header;
    header.mixed = true;
    header.receiver = reader_.device();
    return header;
  }

 private:
  GnssLoggerReader reader_;
  AndroidObservables observables_;
  BroadcastMessages messages_;
  GnssLoggerRecord record_;
  std::vector<RawOutcome> outcomes_;
};

class UbxSource : public EpochSource {
 public:
  explicit UbxSource(UbxReader reader) : reader_(std::move(reader)) {}

  bool Next(ObservationEpoch* epoch) override {
    while (reader_.Next(&record_)) {
      if (const auto* message = std::get_if<LoggedNavigationMessage>(&record_)) {
        messages_.Add(*message);
      } else if (const auto* read = std::get_if<ObservationEpoch>(&record_)) {
        messages_.Add(*read);
        *epoch = *read;
        return true;
      }
    }
    messages_.Finish();
    return false;
  }
  std::span<const NavigationRecord> navigation() const override { return messages_.records(); }
  Status status() const override { return reader_.status(); }
  double progress() const override { return reader_.progress(); }
  RinexObservationHeader header() const override {
    RinexObservationHeader header;
    header.mixed = true;
    header.receiver = "u-blox";
    return header;
  }

 private:
  UbxReader reader_;
  BroadcastMessages messages_;
  UbxRecord record_;
};

class RinexSource : public EpochSource {
 public:
  explicit RinexSource(RinexObservationReader reader) : reader_(std::move(reader)) {}

  bool Next(ObservationEpoch* epoch) override { return reader_.Next(epoch); }
  Status status() const override { return reader_.status(); }
  double progress() const override { return reader_.progress(); }
  RinexObservationHeader header() const override { return reader_.header(); }

 private:
  RinexObservationReader reader_;
};

Result<std::unique_ptr<EpochSource>> OpenSource(const std::string& path, FileKind kind) {
  if (kind == FileKind::kGnssLog) {
    Result<GnssLoggerReader> reader = GnssLoggerReader::Open(path);
    if (!reader) return reader.error();
    return std::unique_ptr<EpochSource>(std::make_unique<LoggerSource>(std::move(reader).value()));
  }
  if (kind == FileKind::kUbx) {
    Result<UbxReader> reader = UbxReader::Open(path);
    if (!reader) return reader.error();
    return std::unique_ptr<EpochSource>(std::make_unique<UbxSource>(std::move(reader).value()));
  }
  Result<RinexObservationReader> reader = RinexObservationReader::Open(path);
  if (!reader) return reader.error();
  return std::unique_ptr<EpochSource>(std::make_unique<RinexSource>(std::move(reader).value()));
}

Status WriteNavigation(std::span<const NavigationRecord> records, const std::string& output) {
  const CalendarTime now = Now();
  RinexNavigationWriterOptions options;
  options.program = "lodemark " + VersionText();
  options.date = Format("%04d%02d%02d %02d%02d%02d UTC", now.year, now.month, now.day, now.hour,
                        now.minute, static_cast<int>(now.second));
  const RinexNavigationFile file = WriteRinexNavigation(records, options);
  const Status written = WriteFileWhole(output, file.text);
  if (!written.ok()) return written;
  PrintResult(output + "  (" + Counted(file.records_written, "record") + ")\n");
  if (file.records_left_out > 0) {
    PrintMessage(output + ": " + GroupDigits(file.records_left_out) +
                 " records have no place in RINEX 3.04 and were left out");
  }
  return {};
}

// Two passes: the header names every type that occurs, so the file is read once before it is
// written. navigation: where the messages of a log go, if it holds any.
Status ConvertObservations(const std::string& input, FileKind kind, const std::string& output,
                           const std::string& navigation) {
  ProgressBar progress("Converting", StderrIsTerminal());
  RinexObservationContents contents;
  ObservationEpoch epoch;
  std::int64_t epochs = 0;
  Result<std::unique_ptr<EpochSource>> first = OpenSource(input, kind);
  if (!first) return first.error();
  while ((*first)->Next(&epoch)) {
    contents.Add(epoch);
    ++epochs;
    progress.Update(0.5 * (*first)->progress());
  }
  const Status read = (*first)->status();
  if (!read.ok()) return read;
  if (epochs == 0) {
    return Error{ErrorCode::kBadData,
                 input + ": holds no epoch of raw measurements to convert" +
                     (kind == FileKind::kGnssLog ? "; switch on raw GNSS measurements in GnssLogger"
                      : kind == FileKind::kUbx   ? "; switch on UBX-RXM-RAWX in the receiver"
                                                 : "")};
  }

  RinexObservationHeader header = (*first)->header();
  header.types = contents.types;
  for (const auto& [slot, channel] : contents.glonass_channels) {
    header.glonass_channels.emplace(slot, channel);
  }
  OutputFile file;
  const Status opened = file.Open(output);
  if (!opened.ok()) return opened;
  RinexObservationFileOptions options;
  options.program = "lodemark " + VersionText();
  options.date = Now();
  RinexObservationWriter writer(std::move(header), options,
                                [&](std::string_view text) { file.Append(text); });
  Result<std::unique_ptr<EpochSource>> second = OpenSource(input, kind);
  if (!second) return second.error();
  while ((*second)->Next(&epoch)) {
    writer.Write(epoch);
    progress.Update(0.5 + 0.5 * (*second)->progress());
  }
  writer.Finish();
  if (!(*second)->status().ok()) return (*second)->status();
  const Status finished = file.Finish();
  if (!finished.ok()) return finished;
  progress.Finish();
  PrintResult(output + "  (" + Counted(epochs, "epoch") + ")\n");
  if (writer.values_left_out() > 0) {
    PrintMessage(output + ": " + GroupDigits(writer.values_left_out()) +
                 " values do not fit into RINEX 3.04 and were left out");
  }
  const std::span<const NavigationRecord> records = (*second)->navigation();
  return records.empty() ? Status() : WriteNavigation(records, navigation);
}

Status ConvertNavigation(const std::string& input, const std::string& output) {
  std::vector<NavigationRecord> records;
  ReadReport report;
  const Status read = ReadRinexNavigation(
      input, [&](const NavigationRecord& record) { records.push_back(record); }, &report);
  if (!read.ok()) return read;
  if (records.empty()) {
    return Error{ErrorCode::kBadData, input + ": holds no navigation record to convert"};
  }
  return WriteNavigation(records, output);
}

Status ConvertFile(const std::string& input, const std::string& folder) {
  const Result<FileKind> kind = SniffFile(input);
  if (!kind) return kind.error();
  const bool navigation = *kind == FileKind::kRinexNavigation;
  if (!navigation && *kind != FileKind::kGnssLog && *kind != FileKind::kRinexObservation &&
      *kind != FileKind::kUbx) {
    return Error{ErrorCode::kBadData, input +
                                          ": cannot be converted; it has to be GnssLogger "
                                          "text, a u-blox file or RINEX"};
  }
  const std::string output = OutputPath(folder, input, navigation ? ".nav" : ".obs");
  const Status other = CheckNotTheInput(input, output);
  if (!other.ok()) return other;
  if (navigation) return ConvertNavigation(input, output);
  const std::string messages = OutputPath(folder, input, ".nav");
  const Status distinct = CheckNotTheInput(input, messages);
  if (!distinct.ok()) return distinct;
  return ConvertObservations(input, *kind, output, messages);
}

}  // namespace

int RunLogConvert(const LogOptions& options) {
  std::error_code failure;
  fs::create_directories(options.out, failure);
  if (failure || !fs::is_directory(options.out, failure)) {
    return ReportError({ErrorCode::kIo, options.out + ": cannot be made a folder" +
                                            (failure ? ": " + failure.message() : "")});
  }
  int exit_code = kExitGood;
  for (const std::string& input : options.files) {
    const Status converted = ConvertFile(input, options.out);
    if (!converted.ok()) exit_code = std::max(exit_code, ReportError(converted.error()));
  }
  return exit_code;
}

}  // namespace lodemark
