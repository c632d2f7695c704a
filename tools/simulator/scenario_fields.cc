#include "tools/simulator/scenario_fields.h"

#include <cstdio>

namespace lodemark {

using nlohmann::json;

void ScenarioFields::Number(const char* name, double low, double high, double* value) {
  const json* field = Take(name);
  if (field == nullptr) return;
  if (!field->is_number()) return Fail(name, "has to be a number");
  const double number = field->get<double>();
  if (!(number >= low && number <= high)) {
    char text[96];
    std::snprintf(text, sizeof text, "has to lie between %g and %g", low, high);
    return Fail(name, text);
  }
  *value = number;
}

void ScenarioFields::Integer(const char* name, std::int64_t low, std::int64_t high,
                             std::int64_t* value) {
  const json* field = Take(name);
  if (field == nullptr) return;
  if (!field->is_number_integer()) return Fail(name, "has to be a whole number");
  const std::int64_t number = field->get<std::int64_t>();
  if (number < low || number > high) {
    return Fail(name, "has to lie between " + std::to_string(low) + " and " + std::to_string(high));
  }
  *value = number;
}

void ScenarioFields::Text(const char* name, std::string* value) {
  const json* field = Take(name);
  if (field == nullptr) return;
  if (!field->is_string()) return Fail(name, "has to be a text");
  *value = field->get<std::string>();
}

void ScenarioFields::Flag(const char* name, bool* value) {
  const json* field = Take(name);
  if (field == nullptr) return;
  if (!field->is_boolean()) return Fail(name, "has to be true or false");
  *value = field->get<bool>();
}

void ScenarioFields::Numbers(const char* name, double low, double high, std::size_t most,
                             std::vector<double>* values) {
  const json* field = Take(name);
  if (field == nullptr) return;
  char text[128];
  std::snprintf(text, sizeof text, "has to be a list of at most %zu numbers between %g and %g",
                most, low, high);
  if (!field->is_array() || field->size() > most) return Fail(name, text);
  values->clear();
  for (const json& number : *field) {
    if (!number.is_number()) return Fail(name, text);
    const double value = number.get<double>();
    if (!(value >= low && value <= high)) return Fail(name, text);
    values->push_back(value);
  }
}

const json* ScenarioFields::Take(const char* name) {
  taken_.emplace_back(name);
  const auto found = object_.find(name);
  return found == object_.end() ? nullptr : &*found;
}

void ScenarioFields::Fail(const std::string& name, const std::string& why) {
  if (!error_) error_ = Error{ErrorCode::kBadData, file_ + ": " + prefix_ + name + " " + why};
}

void ScenarioFields::Adopt(const std::optional<Error>& error) {
  if (!error_ && error) error_ = error;
}

std::optional<Error> ScenarioFields::Verdict() {
  for (const auto& [name, value] : object_.items()) {
    bool known = false;
    for (const std::string& taken : taken_) known = known || taken == name;
    if (!known) Fail(name, "is not a field of a scenario");
  }
  return error_;
}

}  // namespace lodemark
