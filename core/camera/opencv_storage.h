// The fields of OpenCV's yml and xml storages, as far as the description of a camera needs them.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace lodemark {

// A reader of its own, because OpenCV's (4.6) reads outside its memory on broken text.
class OpenCvStorage {
 public:
  // Nothing if the text is neither form, or broken. The text must outlive the storage.
  static std::optional<OpenCvStorage> Parse(std::string_view text);

  // Whether there is an outermost field of that name.
  bool Has(std::string_view name) const;

  // An outermost field that is a number; nothing if it is something else or missing.
  std::optional<double> Number(std::string_view name) const;

  // The entries of an outermost matrix or list; nothing if it is something else, has an entry that
  // is no finite number or more entries than that, or is missing.
  std::optional<std::vector<double>> Numbers(std::string_view name, std::size_t most) const;

 private:
  struct Field {
    std::string_view name;
    std::string_view body;
  };

  static std::optional<OpenCvStorage> ParseYaml(std::string_view text);
  static std::optional<OpenCvStorage> ParseXml(std::string_view text);
  const Field* FieldOf(std::string_view name) const;

  bool is_xml_ = false;
  std::vector<Field> fields_;
};

}  // namespace lodemark
