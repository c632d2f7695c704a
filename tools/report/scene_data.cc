#include "tools/report/scene_data.h"

#include <cstdint>

#include "tools/report/json_columns.h"

namespace lodemark {
namespace {

// One coordinate of each place.
template <typename Places>
void AppendCoordinate(const char* name, const Places& places, std::size_t which,
                      std::string* json) {
  AppendColumn(
      name, places, 1e2, [which](const auto& place) { return ReportNumber(place[which]); }, json);
}

void AppendBuilding(const ReportBuilding& building, std::string* json) {
  *json += "{\"name\":" + JsonString(building.name) + ",\"h\":";
  AppendScaled(building.height_m, 10.0, json);
  *json += ',';
  AppendCoordinate("e", building.outline_m, 0, json);
  *json += ',';
  AppendCoordinate("n", building.outline_m, 1, json);
  *json += '}';
}

void AppendPhoto(const ReportPhoto& photo, std::string* json) {
  *json += "{\"t\":";
  AppendScaled(photo.time_s, 1e3, json);
  *json += ",\"name\":" + JsonString(photo.name) + ",\"w\":";
  AppendInteger(photo.width_px, json);
  *json += ",\"h\":";
  AppendInteger(photo.height_px, json);
  *json += ",\"jpeg\":\"" + Base64(photo.jpeg) + "\"}";
}

void AppendSightsOfPhoto(const ReportSights& of, std::string* json) {
  *json += "{\"p\":";
  AppendInteger(static_cast<std::int64_t>(of.photo), json);
  *json += ",\"counts\":[";
  for (const std::int64_t count : of.counts) {
    AppendInteger(count, json);
    *json += ',';
  }
  json->back() = ']';
  *json += ",\"median\":";
  AppendScaled(of.median_px, 1e2, json);
  *json += ',';
  const auto column = [&](const char* name, double scale, auto value) {
    AppendColumn(name, of.sights, scale, value, json);
    *json += ',';
  };
  column("i", 1.0,
         [](const ReportSight& s) { return ReportNumber(static_cast<double>(s.landmark)); });
  column("x", 1.0, [](const ReportSight& s) { return ReportNumber(s.x_px); });
  column("y", 1.0, [](const ReportSight& s) { return ReportNumber(s.y_px); });
  const auto residual = [](std::size_t which) {
    return [which](const ReportSight& s) {
      return s.residual_px ? ReportNumber((*s.residual_px)[which]) : std::nullopt;
    };
  };
  column("rx", 1e2, residual(0));
  column("ry", 1e2, residual(1));
  *json += "\"states\":\"";
  for (const ReportSight& sight : of.sights) *json += StateLetter(sight.state);
  *json += "\"}";
}

}  // namespace

void AppendScene(const ReportScene& scene, std::string* json) {
  *json += "\"scene\":{\"landmarks\":{";
  AppendCoordinate("e", scene.landmarks, 0, json);
  *json += ',';
  AppendCoordinate("n", scene.landmarks, 1, json);
  *json += "},";
  AppendArray(
      "buildings", scene.buildings, [json](const ReportBuilding& b) { AppendBuilding(b, json); },
      json);
  *json += ',';
  AppendArray("photos", scene.photos, [json](const ReportPhoto& p) { AppendPhoto(p, json); }, json);
  *json += '}';
}

void AppendSights(const std::vector<ReportSignalState>& landmarks,
                  const std::vector<ReportSights>& sights, std::string* json) {
  *json += "\"landmarks\":\"";
  for (const ReportSignalState state : landmarks) *json += StateLetter(state);
  *json += "\",";
  AppendArray(
      "sights", sights, [json](const ReportSights& of) { AppendSightsOfPhoto(of, json); }, json);
}

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      three = three << 8;
      if (at + i < bytes.size()) three |= static_cast<unsigned char>(bytes[at + i]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      text += at + i <= bytes.size() ? kDigits[(three >> (18 - 6 * i)) & 63u] : '=';
    }
  }
  return text;
}

}  // namespace lodemark
