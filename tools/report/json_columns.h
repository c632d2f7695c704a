// Pieces of compact JSON: texts, integers, and columns of scaled numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/report/report.h"

namespace lodemark {

using ReportNumber = std::optional<double>;

void AppendInteger(std::int64_t value, std::string* json);

// scale times the value as an integer, null if it is unknown or absurd.
void AppendScaled(ReportNumber value, double scale, std::string* json);

// The letter of a state in the page's strings of states.
char StateLetter(ReportSignalState state);

// "name":[...], with append called for each item.
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

// The same, but empty where no item has a value.
template <typename Items, typename Function>
void AppendKnownColumn(const char* name, const Items& items, double scale, Function value,
                       std::string* json) {
  for (const auto& item : items) {
    if (!value(item)) continue;
    AppendColumn(name, items, scale, value, json);
    return;
  }
  *json += JsonString(name) + ":[]";
}

}  // namespace lodemark
