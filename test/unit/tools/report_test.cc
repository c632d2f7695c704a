#include "tools/report/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace lodemark {
namespace {

constexpr const char* kHostile = "</script><script>alert('1')</script> & \"\xE2\x80\xA8\xFF\x01";

std::size_t Occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

Report SmallReport() {
  Report report;
  report.title = "a run";
  ReportRun run;
  run.name = "a run";
  run.epoch_count = 2;
  run.span_s = 1.0;
  ReportEpoch epoch;
  epoch.answered = true;
  epoch.east_m = 1.234;
  epoch.accuracy_m = 4.5;
  epoch.status = "fix";
  run.epochs.push_back(epoch);
  ReportEpoch silent;
  silent.time_s = 1.0;
  silent.status = "too_few_satellites";
  run.epochs.push_back(silent);
  report.runs.push_back(run);
  return report;
}

TEST(JsonString, ReadsBackAsTheSameText) {
  const std::string text = "tab\t quote\" back\\ \xC3\xA9 \xE2\x82\xAC \xF0\x9F\x9B\xB0 </a> \x7F";
  EXPECT_EQ(nlohmann::json::parse(JsonString(text)).get<std::string>(), text);
}

TEST(JsonString, ReplacesBytesThatAreNotUtf8) {
  for (const char* bytes : {"\xFF", "\xC0\x80", "\xE2\x82", "\xED\xA0\x80", "\xF5\x80\x80\x80"}) {
    const auto parsed = nlohmann::json::parse(JsonString(bytes), nullptr, false);
    ASSERT_FALSE(parsed.is_discarded());
    EXPECT_NE(parsed.get<std::string>().find("\xEF\xBF\xBD"), std::string::npos);
  }
}

TEST(EscapeHtml, LeavesNothingThatOpensATagOrEndsAnAttribute) {
  const std::string escaped = EscapeHtml(kHostile);
  EXPECT_EQ(escaped.find_first_of("<>\"'"), std::string::npos);
}

TEST(ReportHtml, KeepsHostileTextsOutOfMarkupAndScript) {
  const std::string calm = ReportHtml(SmallReport());
  Report report = SmallReport();
  report.title = report.subtitle = report.generator = report.start = kHostile;
  report.figures.push_back({kHostile, kHostile, kHostile, kHostile});
  report.table.push_back({true, kHostile, {}, kHostile});
  report.table.push_back({false, kHostile, {kHostile}, kHostile});
  ReportRun& run = report.runs.front();
  run.name = kHostile;
  run.epochs.front().status = kHostile;
  run.events.push_back({0.0, kHostile, kHostile});
  ReportSignal signal;
  signal.satellite = signal.signal = signal.main_reason = kHostile;
  run.signals.push_back(signal);
  const std::string html = ReportHtml(report);
  for (const char* tag : {"<script", "</script"}) {
    EXPECT_EQ(Occurrences(html, tag), Occurrences(calm, tag)) << tag;
  }
  EXPECT_EQ(ReportDataJson(report).find('<'), std::string::npos);
}

TEST(ReportHtml, AsksForNothingFromOutside) {
  const std::string html = ReportHtml(SmallReport());
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  for (const char* request : {" src=", " href=", "@import", "url(http", "fetch("}) {
    EXPECT_EQ(html.find(request), std::string::npos) << request;
  }
}

TEST(ReportDataJson, HoldsColumnsOfIntegersWithGaps) {
  const auto json = nlohmann::json::parse(ReportDataJson(SmallReport()));
  const auto& run = json["runs"][0];
  EXPECT_EQ(run["t"], nlohmann::json::parse("[0, 1000]"));
  EXPECT_EQ(run["e"], nlohmann::json::parse("[123, null]"));
  EXPECT_EQ(run["acc"], nlohmann::json::parse("[450, null]"));
  EXPECT_EQ(run["statuses"][run["status"][1].get<std::size_t>()], "too_few_satellites");
}

TEST(ReportDataJson, WritesAbsurdNumbersAsUnknown) {
  Report report = SmallReport();
  report.runs[0].epochs[0].east_m = std::numeric_limits<double>::infinity();
  report.runs[0].epochs[0].north_m = 1e300;
  report.runs[0].epochs[0].up_m = std::numeric_limits<double>::quiet_NaN();
  const auto json = nlohmann::json::parse(ReportDataJson(report), nullptr, false);
  ASSERT_FALSE(json.is_discarded());
  for (const char* name : {"e", "n", "u"}) EXPECT_TRUE(json["runs"][0][name][0].is_null()) << name;
}

}  // namespace
}  // namespace lodemark
