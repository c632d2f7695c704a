#include "core/camera/opencv_storage.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace lodemark {
namespace {

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::size_t kMostFields = 10'000;

std::string_view Trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::optional<double> ToNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

// The text between two marks.
std::optional<std::string_view> Between(std::string_view text, std::string_view open,
                                        std::string_view close) {
  const std::size_t begin = text.find(open);
  if (begin == std::string_view::npos) return std::nullopt;
  text.remove_prefix(begin + open.size());
  const std::size_t end = text.find(close);
  if (end == std::string_view::npos) return std::nullopt;
  return text.substr(0, end);
}

std::optional<std::vector<double>> ToNumbers(std::string_view text, std::string_view separators,
                                             std::size_t most) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = text.find_first_not_of(separators);
    if (begin == std::string_view::npos) return numbers;
    text.remove_prefix(begin);
    const std::size_t end = std::min(text.find_first_of(separators), text.size());
    const std::optional<double> number = ToNumber(text.substr(0, end));
    if (!number || numbers.size() == most) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(end);
  }
}

// One <...> of an xml text.
struct Tag {
  enum class Kind { kOpen, kClose, kEmpty, kOther } kind = Kind::kOther;
  std::string_view name;
  std::size_t begin = 0;
  std::size_t end = 0;
};

// The next tag from a place on; comments and processing instructions are of other kind. Nothing at
// the end, with complete set to false where the text ends inside a tag.
std::optional<Tag> NextTag(std::string_view text, std::size_t from, bool* complete) {
  *complete = true;
  Tag tag;
  tag.begin = text.find('<', from);
  if (tag.begin == std::string_view::npos) return std::nullopt;
  std::string_view rest = text.substr(tag.begin);
  const std::string_view close = rest.starts_with("<!--") ? "-->" : ">";
  const std::size_t length = rest.find(close, close.size() == 3 ? 4 : 1);
  *complete = length != std::string_view::npos;
  if (!*complete) return std::nullopt;
  tag.end = tag.begin + length + close.size();
  rest = rest.substr(1, length - 1);
  if (rest.starts_with('!') || rest.starts_with('?')) return tag;
  tag.kind = Tag::Kind::kOpen;
  if (rest.starts_with('/')) {
    tag.kind = Tag::Kind::kClose;
    rest.remove_prefix(1);
  } else if (rest.ends_with('/')) {
    tag.kind = Tag::Kind::kEmpty;
    rest.remove_suffix(1);
  }
  tag.name = rest.substr(0, std::min(rest.find_first_of(kSpace), rest.size()));
  return tag;
}

}  // namespace

std::optional<OpenCvStorage> OpenCvStorage::Parse(std::string_view text) {
  if (text.starts_with("%YAML")) return ParseYaml(text);
  if (text.starts_with("<?xml")) return ParseXml(text);
  return std::nullopt;
}

// A field begins at the margin with its name and a colon; what belongs to it is indented.
std::optional<OpenCvStorage> OpenCvStorage::ParseYaml(std::string_view text) {
  OpenCvStorage storage;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const bool is_content = !line.empty() && kSpace.find(line[0]) == std::string_view::npos &&
                            line[0] != '%' && line[0] != '#';
    const std::size_t colon = line.find(':');
    if (is_content && colon != std::string_view::npos) {
      if (storage.fields_.size() == kMostFields) return std::nullopt;
      storage.fields_.push_back({Trimmed(line.substr(0, colon)), line.substr(colon + 1)});
    } else if (!is_content && !storage.fields_.empty() && !line.starts_with('%')) {
      // The body reaches to the end of this line.
      std::string_view& body = storage.fields_.back().body;
      body = {body.data(), static_cast<std::size_t>(line.data() + line.size() - body.data())};
    }
    begin = end + 1;
  }
  return storage;
}

// <opencv_storage> holds the fields; what is inside them is looked at when it is asked for.
std::optional<OpenCvStorage> OpenCvStorage::ParseXml(std::string_view text) {
  OpenCvStorage storage;
  storage.is_xml_ = true;
  std::size_t depth = 0;
  std::size_t body_begin = 0;
  std::string_view name;
  bool complete = true;
  std::size_t at = 0;
  while (const std::optional<Tag> tag = NextTag(text, at, &complete)) {
    at = tag->end;
    if (tag->kind == Tag::Kind::kOpen) {
      if (depth == 0 && tag->name != "opencv_storage") return std::nullopt;
      if (depth == 1) {
        name = tag->name;
        body_begin = tag->end;
      }
      ++depth;
    } else if (tag->kind == Tag::Kind::kClose) {
      if (depth == 0) return std::nullopt;
      --depth;
      if (depth == 1) {
        if (tag->name != name || storage.fields_.size() == kMostFields) return std::nullopt;
        storage.fields_.push_back({name, text.substr(body_begin, tag->begin - body_begin)});
      }
    }
  }
  if (!complete || depth != 0) return std::nullopt;
  return storage;
}

const OpenCvStorage::Field* OpenCvStorage::FieldOf(std::string_view name) const {
  for (const Field& field : fields_) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

bool OpenCvStorage::Has(std::string_view name) const { return FieldOf(name) != nullptr; }

std::optional<double> OpenCvStorage::Number(std::string_view name) const {
  const Field* const field = FieldOf(name);
  return field != nullptr ? ToNumber(Trimmed(field->body)) : std::nullopt;
}

std::optional<std::vector<double>> OpenCvStorage::Numbers(std::string_view name,
                                                          std::size_t most) const {
  const Field* const field = FieldOf(name);
  if (field == nullptr) return std::nullopt;
  const std::string_view body = field->body;
  if (is_xml_) {
    const std::optional<std::string_view> data = Between(body, "<data>", "</data>");
    return ToNumbers(data.value_or(body), kSpace, most);
  }
  const std::optional<std::string_view> list = Between(body, "[", "]");
  if (!list) return std::nullopt;
  return ToNumbers(*list, ", \t\r\n", most);
}

}  // namespace lodemark
