// The report's data as compact JSON: columns of integers in centimetres and milliseconds.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "tools/report/report.h"

namespace lodemark {
namespace {

// Decodes one code point at text[*at] and advances; U+FFFD for malformed UTF-8.
char32_t NextCodePoint(std::string_view text, std::size_t* at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(*at);
  ++*at;
  if (first < 0x80) return first;
  std::size_t more = 0;
  char32_t code = 0;
  if (first >= 0xC2 && first <= 0xDF) {
    more = 1;
    code = first & 0x1Fu;
  } else if (first >= 0xE0 && first <= 0xEF) {
    more = 2;
    code = first & 0x0Fu;
  } else if (first >= 0xF0 && first <= 0xF4) {
    more = 3;
    code = first & 0x07u;
  } else {
    return 0xFFFD;
  }
  for (std::size_t i = 0; i < more; ++i) {
    if (*at >= text.size() || (byte(*at) & 0xC0u) != 0x80u) return 0xFFFD;
    code = (code << 6) | (byte(*at) & 0x3Fu);
    ++*at;
  }
  const bool overlong = (more == 2 && code < 0x800) || (more == 3 && code < 0x10000);
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return overlong || surrogate || code > 0x10FFFF ? char32_t{0xFFFD} : code;
}

void AppendUtf8(char32_t code, std::string* text) {
  const auto push = [text](char32_t byte) { text->push_back(static_cast<char>(byte)); };
  if (code < 0x80) {
    push(code);
  } else if (code < 0x800) {
    push(0xC0u | (code >> 6));
    push(0x80u | (code & 0x3Fu));
  } else if (code < 0x10000) {
    push(0xE0u | (code >> 12));
    push(0x80u | ((code >> 6) & 0x3Fu));
    push(0x80u | (code & 0x3Fu));
  } else {
    push(0xF0u | (code >> 18));
    push(0x80u | ((code >> 12) & 0x3Fu));
    push(0x80u | ((code >> 6) & 0x3Fu));
    push(0x80u | (code & 0x3Fu));
  }
}

void AppendInteger(std::int64_t value, std::string* json) {
  char digits[24];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  json->append(digits, end);
}

// scale times the value as an integer, null if it is unknown or absurd.
void AppendScaled(std::optional<double> value, double scale, std::string* json) {
  if (!value || !std::isfinite(*value) || std::abs(*value * scale) > 9e15) {
    *json += "null";
  } else {
    AppendInteger(std::llround(*value * scale), json);
  }
}

template <typename Items, typename Function>
void AppendArray(const char* name, const Items& items, Function append, std::string* json) {
  *json += JsonString(name) + ":[";
  bool first = true;
  for (const auto& item : items) {
    if (!first) *json += ',';
    first = false;
    append(item);
  }
  *json += ']';
}

template <typename Items, typename Function>
void AppendColumn(const char* name, const Items& items, double scale, Function value,
                  std::string* json) {
  AppendArray(name, items, [&](const auto& item) { AppendScaled(value(item), scale, json); }, json);
}

using Number = std::optional<double>;

void AppendEpochs(const std::vector<ReportEpoch>& epochs, std::string* json) {
  const auto answered = [](const ReportEpoch& e, double value) {
    return e.answered ? Number(value) : std::nullopt;
  };
  AppendColumn("t", epochs, 1e3, [](const ReportEpoch& e) { return Number(e.time_s); }, json);
  *json += ',';
  AppendColumn("e", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.east_m); }, json);
  *json += ',';
  AppendColumn(
      "n", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.north_m); }, json);
  *json += ',';
  AppendColumn("u", epochs, 1e2, [&](const ReportEpoch& e) { return answered(e, e.up_m); }, json);
  *json += ',';
  AppendColumn("acc", epochs, 1e2, [](const ReportEpoch& e) { return e.accuracy_m; }, json);
  *json += ',';
  AppendColumn(
      "vacc", epochs, 1e2, [](const ReportEpoch& e) { return e.vertical_accuracy_m; }, json);
  *json += ',';
  AppendColumn(
      "ee", epochs, 1e2,
      [](const ReportEpoch& e) { return e.error_m ? Number((*e.error_m)[0]) : std::nullopt; },
      json);
  *json += ',';
  AppendColumn(
      "en", epochs, 1e2,
      [](const ReportEpoch& e) { return e.error_m ? Number((*e.error_m)[1]) : std::nullopt; },
      json);
  *json += ',';
  AppendColumn("eu", epochs, 1e2, [](const ReportEpoch& e) { return e.up_error_m; }, json);
  *json += ',';
  AppendColumn(
      "used", epochs, 1.0,
      [](const ReportEpoch& e) {
        return e.satellites_used ? Number(*e.satellites_used) : std::nullopt;
      },
      json);
  *json += ',';
  AppendArray(
      "ell", epochs,
      [json](const ReportEpoch& e) {
        if (!e.ellipse) {
          *json += '0';
          return;
        }
        *json += '[';
        AppendScaled(e.ellipse->semi_major_m, 1e2, json);
        *json += ',';
        AppendScaled(e.ellipse->semi_minor_m, 1e2, json);
        *json += ',';
        AppendScaled(e.ellipse->azimuth_deg, 1.0, json);
        *json += ']';
      },
      json);
  std::map<std::string, int> places;
  for (const ReportEpoch& epoch : epochs) places.emplace(epoch.status, 0);
  int place = 0;
  for (auto& [status, index] : places) index = place++;
  *json += ',';
  AppendArray(
      "statuses", places, [json](const auto& entry) { *json += JsonString(entry.first); }, json);
  *json += ',';
  AppendArray(
      "status", epochs,
      [&](const ReportEpoch& e) { AppendInteger(places.find(e.status)->second, json); }, json);
}

char StateLetter(ReportSignalState state) {
  switch (state) {
    case ReportSignalState::kUnusable:
      return 'x';
    case ReportSignalState::kUsed:
      return 'u';
    case ReportSignalState::kDownWeighted:
      return 'd';
    case ReportSignalState::kRejected:
      return 'r';
    case ReportSignalState::kAbsent:
      break;
  }
  return '-';
}

void AppendSignal(const ReportSignal& signal, std::string* json) {
  *json += "{\"sat\":" + JsonString(signal.satellite) + ",\"sig\":" + JsonString(signal.signal);
  *json += ",\"states\":\"";
  for (const ReportSignalState state : signal.states) *json += StateLetter(state);
  *json += "\",\"counts\":[";
  for (const std::int64_t count :
       {signal.seen, signal.used, signal.down_weighted, signal.rejected}) {
    AppendInteger(count, json);
    *json += ',';
  }
  json->back() = ']';
  *json += ",\"reason\":" + JsonString(signal.main_reason) + ",\"cn0mean\":";
  AppendScaled(signal.mean_cn0_dbhz, 10.0, json);
  *json += ",\"rms\":";
  AppendScaled(signal.rms_residual_m, 1e2, json);
  *json += ',';
  AppendColumn("cn0", signal.cn0_dbhz, 1.0, [](Number value) { return value; }, json);
  *json += ',';
  const auto part = [](std::size_t which) {
    return [which](const std::optional<std::array<double, 2>>& direction) {
      return direction ? Number((*direction)[which]) : std::nullopt;
    };
  };
  AppendColumn("az", signal.direction_deg, 1.0, part(0), json);
  *json += ',';
  AppendColumn("el", signal.direction_deg, 1.0, part(1), json);
  *json += '}';
}

void AppendRun(const ReportRun& run, std::string* json) {
  *json += "{\"name\":" + JsonString(run.name) + ",\"count\":";
  AppendInteger(run.epoch_count, json);
  *json += ",\"span\":";
  AppendScaled(run.span_s, 1e3, json);
  *json += ',';
  AppendEpochs(run.epochs, json);
  *json += ',';
  AppendColumn("cdf", run.error_quantiles_m, 1e2, [](double value) { return Number(value); }, json);
  *json += ',';
  AppendArray(
      "signals", run.signals, [json](const ReportSignal& s) { AppendSignal(s, json); }, json);
  *json += ',';
  AppendArray(
      "events", run.events,
      [json](const ReportEvent& event) {
        *json += '[';
        AppendScaled(event.time_s, 1e3, json);
        *json += ',' + JsonString(event.event) + ',' + JsonString(event.text) + ']';
      },
      json);
  *json += ",\"eventCount\":";
  AppendInteger(run.event_count, json);
  *json += '}';
}

}  // namespace

std::string JsonString(std::string_view text) {
  std::string json = "\"";
  std::size_t at = 0;
  while (at < text.size()) {
    const char32_t code = NextCodePoint(text, &at);
    const bool escaped = code < 0x20 || code == '"' || code == '\\' || code == '<' || code == '>' ||
                         code == '&' || code == 0x7F || code == 0x2028 || code == 0x2029;
    if (!escaped) {
      AppendUtf8(code, &json);
      continue;
    }
    constexpr char kHex[] = "0123456789abcdef";
    json += "\\u";
    for (int shift = 12; shift >= 0; shift -= 4) json += kHex[(code >> shift) & 0xFu];
  }
  return json + '"';
}

std::string ReportDataJson(const Report& report) {
  std::string json = "{\"start\":" + JsonString(report.start) + ',';
  using Point = ReportTruthPoint;
  json += "\"truth\":{";
  AppendColumn("t", report.truth, 1e3, [](const Point& p) { return Number(p.time_s); }, &json);
  json += ',';
  AppendColumn("e", report.truth, 1e2, [](const Point& p) { return Number(p.east_m); }, &json);
  json += ',';
  AppendColumn("n", report.truth, 1e2, [](const Point& p) { return Number(p.north_m); }, &json);
  json += "},";
  AppendArray("runs", report.runs, [&](const ReportRun& run) { AppendRun(run, &json); }, &json);
  return json + '}';
}

}  // namespace lodemark
