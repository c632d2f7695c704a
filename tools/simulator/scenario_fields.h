// Reads the members of a JSON object of a scenario, and remembers the first that is wrong.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace lodemark {

class ScenarioFields {
 public:
  // Messages begin with the file and the prefix, as "place." or "scene.buildings[3].".
  ScenarioFields(std::string file, const nlohmann::json& object, std::string prefix)
      : file_(std::move(file)), object_(object), prefix_(std::move(prefix)) {}

  // These leave *value alone where the member is missing.
  void Number(const char* name, double low, double high, double* value);
  void Integer(const char* name, std::int64_t low, std::int64_t high, std::int64_t* value);
  void Text(const char* name, std::string* value);
  void Flag(const char* name, bool* value);

  // A list of numbers, of at most the given length.
  void Numbers(const char* name, double low, double high, std::size_t most,
               std::vector<double>* values);

  // The member as it is, or null. It counts as known from then on.
  const nlohmann::json* Take(const char* name);

  void Fail(const std::string& name, const std::string& why);

  // Takes over the failure of an object inside.
  void Adopt(const std::optional<Error>& error);

  // Reads a list of objects: each(fields of the object) for every one.
  template <class Each>
  void Objects(const char* name, std::size_t most, const Each& each) {
    const nlohmann::json* const list = Take(name);
    if (list == nullptr) return;
    if (!list->is_array() || list->size() > most) {
      return Fail(name, "has to be a list of at most " + std::to_string(most));
    }
    std::size_t i = 0;
    for (const nlohmann::json& object : *list) {
      const std::string inside = prefix_ + name + "[" + std::to_string(i++) + "]";
      if (!object.is_object())
        return Adopt(Error{ErrorCode::kBadData, file_ + ": " + inside + " has to be an object"});
      ScenarioFields fields(file_, object, inside + ".");
      each(&fields);
      Adopt(fields.Verdict());
    }
  }

  // The first failure; an unknown member is one.
  std::optional<Error> Verdict();

  const std::string& file() const { return file_; }
  const std::string& prefix() const { return prefix_; }
  bool good() const { return !error_; }

 private:
  std::string file_;
  const nlohmann::json& object_;
  std::string prefix_;
  std::vector<std::string> taken_;
  std::optional<Error> error_;
};

}  // namespace lodemark
