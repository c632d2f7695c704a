#include "tools/mapping/footprints.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

namespace lodemark {
namespace {

using nlohmann::json;

constexpr double kTallest_m = 1'000.0;
constexpr double kLargestExtent_deg = 0.1;  // of one building: some 10 km
constexpr std::size_t kLongestName_bytes = 200;
constexpr double kFoot_m = 0.3048;

// Text without control characters, which a map does not take, and cut where a character ends.
std::string PlainName(const std::string& text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 || byte == 0x7f) continue;
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {
      ++i;
      continue;
    }
    if (plain.size() >= kLongestName_bytes && (byte & 0xc0) != 0x80) break;
    plain.push_back(text[i]);
  }
  return plain;
}

// What is known of a feature while it is read, and the sentences about it.
class FeatureReader {
 public:
  FeatureReader(const std::string& file, const HeightRules& rules, std::size_t number,
                const json& feature)
      : file_(file), rules_(rules), feature_(feature) {
    footprint_.feature = number;
  }

  // None for what is no building.
  Result<std::optional<Footprint>> Read(bool only_tagged) {
    if (!feature_.is_object() || Text(feature_, "type") != "Feature") {
      return Bad("is no GeoJSON Feature");
    }
    Name();
    const auto geometry = feature_.find("geometry");
    if (geometry == feature_.end()) return Bad("has no geometry");
    if (geometry->is_null()) return std::optional<Footprint>();
    if (!geometry->is_object()) return Bad("its geometry is no object");
    const std::string type = Text(*geometry, "type");
    if (!IsBuilding(only_tagged)) return std::optional<Footprint>();
    if (type != "Polygon" && type != "MultiPolygon") {
      if (!type.empty()) return std::optional<Footprint>();
      return Bad("its geometry has no type");
    }
    const auto coordinates = geometry->find("coordinates");
    if (coordinates == geometry->end() || !coordinates->is_array()) {
      return Bad("its geometry has no coordinates");
    }
    if (type == "Polygon") {
      if (!ReadOutline(*coordinates)) return error_;
    } else {
      for (const json& polygon : *coordinates) {
        if (!ReadOutline(polygon)) return error_;
      }
    }
    if (footprint_.outlines_deg.empty()) return std::optional<Footprint>();
    if (!ReadHeights()) return error_;
    return std::optional<Footprint>(std::move(footprint_));
  }

  bool used_default() const { return used_default_; }
  bool odd_height() const { return odd_height_; }
  std::string Where() const {
    std::string where = file_ + ": feature " + std::to_string(footprint_.feature);
    if (!name_.empty()) where += " (" + name_ + ")";
    return where;
  }

 private:
  Error Bad(const std::string& why) const { return {ErrorCode::kBadData, Where() + ": " + why}; }
  bool Fail(const std::string& why) {
    error_ = Bad(why);
    return false;
  }

  static std::string Text(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
  }

  // Overpass and osmtogeojson put tags into properties, others into properties.tags.
  const json* Tag(const char* key) const {
    const auto properties = feature_.find("properties");
    if (properties == feature_.end() || !properties->is_object()) return nullptr;
    if (const auto found = properties->find(key); found != properties->end()) {
      return found->is_null() ? nullptr : &*found;
    }
    const auto tags = properties->find("tags");
    if (tags == properties->end() || !tags->is_object()) return nullptr;
    const auto found = tags->find(key);
    return found == tags->end() || found->is_null() ? nullptr : &*found;
  }

  std::string TagText(const char* key) const {
    const json* tag = Tag(key);
    return tag != nullptr && tag->is_string() ? tag->get<std::string>() : "";
  }

  void Name() {
    for (const char* key : {"name", "@id", "id"}) {
      footprint_.building = PlainName(TagText(key));
      if (!footprint_.building.empty()) break;
    }
    const auto id = feature_.find("id");
    if (footprint_.building.empty() && id != feature_.end()) {
      if (id->is_string()) footprint_.building = PlainName(id->get<std::string>());
      if (id->is_number_integer()) footprint_.building = std::to_string(id->get<std::int64_t>());
    }
    name_ = footprint_.building;
    if (name_.empty()) footprint_.building = "feature " + std::to_string(footprint_.feature);
  }

  bool IsBuilding(bool only_tagged) {
    const std::string building = TagText("building");
    const std::string part = TagText("building:part");
    footprint_.is_part = !part.empty() && part != "no" && (building.empty() || building == "no");
    if (footprint_.is_part) return TagText("location") != "underground";
    if (building == "no" || TagText("location") == "underground") return false;
    return !only_tagged || Tag("building") != nullptr;
  }

  bool ReadRing(const json& positions, Ring* ring) {
    if (!positions.is_array()) return Fail("a ring is no list of positions");
    for (const json& position : positions) {
      if (!position.is_array() || position.size() < 2 || !position[0].is_number() ||
          !position[1].is_number()) {
        return Fail("a position is not [longitude, latitude]");
      }
      const double longitude_deg = position[0].get<double>();
      const double latitude_deg = position[1].get<double>();
      if (!(std::abs(longitude_deg) <= 180.0) || !(std::abs(latitude_deg) <= 90.0)) {
        return Fail("a position is not on the earth: longitude -180 to 180, latitude -90 to 90");
      }
      ring->emplace_back(longitude_deg, latitude_deg);
    }
    if (ring->size() < 4) return Fail("a ring has fewer than four positions");
    if (ring->front() != ring->back()) {
      return Fail("a ring is not closed: its last position is not its first");
    }
    ring->pop_back();
    return true;
  }

  bool ReadOutline(const json& rings) {
    if (!rings.is_array() || rings.empty()) return Fail("a polygon is no list of rings");
    Outline outline;
    if (!ReadRing(rings[0], &outline.outer)) return false;
    for (std::size_t i = 1; i < rings.size(); ++i) {
      Ring hole;
      if (!ReadRing(rings[i], &hole)) return false;
      outline.holes.push_back(std::move(hole));
    }
    Eigen::Vector2d least = outline.outer.front();
    Eigen::Vector2d greatest = least;
    for (const Eigen::Vector2d& corner : outline.outer) {
      least = least.cwiseMin(corner);
      greatest = greatest.cwiseMax(corner);
    }
    if ((greatest - least).maxCoeff() > kLargestExtent_deg) {
      return Fail("is larger than 0.1 degrees, which no building is");
    }
    footprint_.outlines_deg.push_back(std::move(outline));
    return true;
  }

  // Empty where there is no such tag, or one that is no length; the latter is noted.
  std::optional<double> Length_m(const char* key, double unit_m) {
    const json* tag = Tag(key);
    if (tag == nullptr) return std::nullopt;
    std::optional<double> length;
    if (tag->is_number()) length = tag->get<double>();
    if (tag->is_string()) length = ParseLength_m(tag->get<std::string>());
    if (!length || !std::isfinite(*length)) {
      odd_height_ = true;
      return std::nullopt;
    }
    return *length * unit_m;
  }

  bool ReadHeights() {
    std::optional<double> top_m = Length_m("height", 1.0);
    std::optional<double> levels_m = Length_m("building:levels", rules_.level_m);
    std::optional<double> base_m = Length_m("min_height", 1.0);
    if (!base_m) base_m = Length_m("building:min_level", rules_.level_m);
    footprint_.base_m = base_m.value_or(0.0);
    // Some sources write -1 or 0 where they do not know.
    if (top_m && *top_m <= 0.0) top_m.reset();
    if (levels_m && *levels_m <= 0.0) levels_m.reset();
    if (top_m) {
      footprint_.top_m = *top_m;
      footprint_.top_sigma_m = rules_.given_sigma_m;
    } else if (levels_m) {
      footprint_.top_m = *levels_m;
      footprint_.top_sigma_m = std::hypot(rules_.levels_sigma_m, rules_.levels_share * *levels_m);
    } else {
      // Of what begins in the air, so much above where it begins.
      footprint_.top_m = footprint_.base_m + rules_.default_m;
      footprint_.top_sigma_m = rules_.default_sigma_m;
      used_default_ = true;
    }
    if (!(footprint_.base_m >= 0.0)) return Fail("its min_height is below the ground");
    if (!(footprint_.top_m <= kTallest_m)) return Fail("is taller than 1,000 m");
    if (!(footprint_.top_m > footprint_.base_m)) {
      return Fail("its height is not above its min_height");
    }
    return true;
  }

  const std::string& file_;
  const HeightRules& rules_;
  const json& feature_;
  Footprint footprint_;
  Error error_;
  std::string name_;  // as the file has it
  bool used_default_ = false;
  bool odd_height_ = false;
};

// Whether the file tells buildings from other things.
bool AnyTagged(const json& features) {
  for (const json& feature : features) {
    if (!feature.is_object()) continue;
    const auto properties = feature.find("properties");
    if (properties == feature.end() || !properties->is_object()) continue;
    const auto tags = properties->find("tags");
    for (const json* object : {&*properties, tags == properties->end() ? nullptr : &*tags}) {
      if (object == nullptr || !object->is_object()) continue;
      if (object->contains("building") || object->contains("building:part")) return true;
    }
  }
  return false;
}

// WGS 84 with longitude first is all that RFC 7946 has; older files may name another system.
bool IsOtherSystem(const json& document) {
  const auto crs = document.find("crs");
  if (crs == document.end() || crs->is_null()) return false;
  const std::string text = crs->dump(-1, ' ', true, json::error_handler_t::replace);
  return text.find("CRS84") == std::string::npos && text.find("4326") == std::string::npos;
}

std::size_t LineOf(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  return static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
}

}  // namespace

std::optional<double> ParseLength_m(std::string_view text) {
  const auto skip_blanks = [&text] {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  };
  const auto take_number = [&text]() -> std::optional<double> {
    double value = 0.0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    return value;
  };
  skip_blanks();
  const std::optional<double> number = take_number();
  if (!number) return std::nullopt;
  skip_blanks();
  if (text.empty() || text == "m" || text == "metres" || text == "meters") return number;
  if (text == "ft" || text == "feet" || text == "'") return *number * kFoot_m;
  if (text.front() != '\'') return std::nullopt;
  text.remove_prefix(1);
  skip_blanks();
  const std::optional<double> inches = take_number();
  if (!inches || text != "\"") return std::nullopt;
  return (*number + *inches / 12.0) * kFoot_m;
}

Result<Footprints> ParseFootprints(const std::string& name, std::string_view text,
                                   const HeightRules& rules) {
  const auto bad = [&name](const std::string& why) {
    return Error{ErrorCode::kBadData, name + ": " + why};
  };
  json document;
  try {
    document = json::parse(text);
  } catch (const json::parse_error& error) {
    return bad("is no GeoJSON: not JSON in line " + std::to_string(LineOf(text, error.byte)));
  } catch (const json::exception&) {
    return bad("is no GeoJSON: it has a number that is too large");
  }
  if (!document.is_object()) return bad("is no GeoJSON FeatureCollection");
  if (IsOtherSystem(document)) {
    return bad("is not in longitude and latitude of WGS 84; convert it first");
  }
  const auto type = document.find("type");
  json features = json::array();
  if (type != document.end() && *type == "FeatureCollection") {
    const auto list = document.find("features");
    if (list == document.end() || !list->is_array()) return bad("has no list of features");
    features = std::move(*list);
  } else if (type != document.end() && *type == "Feature") {
    features.push_back(std::move(document));
  } else {
    return bad("is no GeoJSON FeatureCollection");
  }

  Footprints footprints;
  std::size_t passed_over = 0;
  std::size_t odd = 0;
  std::string first_odd;
  const bool only_tagged = AnyTagged(features);
  std::size_t number = 0;
  for (const json& feature : features) {
    FeatureReader reader(name, rules, ++number, feature);
    Result<std::optional<Footprint>> read = reader.Read(only_tagged);
    if (!read) return read.error();
    if (!*read) {
      ++passed_over;
      continue;
    }
    if (reader.used_default()) ++footprints.without_height;
    if (reader.odd_height() && odd++ == 0) first_odd = reader.Where();
    footprints.buildings.push_back(std::move(**read));
  }
  if (footprints.buildings.empty()) return bad("holds no footprint of a building");
  if (passed_over > 0) {
    footprints.notes.push_back(name + ": " + std::to_string(passed_over) +
                               " features passed over that are no buildings with an area");
  }
  if (odd > 0) {
    footprints.notes.push_back(first_odd + ": a height that is no number was ignored" +
                               (odd > 1 ? ", and " + std::to_string(odd - 1) + " more" : ""));
  }
  return footprints;
}

}  // namespace lodemark
