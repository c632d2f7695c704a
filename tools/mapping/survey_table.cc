#include "tools/mapping/survey_table.h"

#include <array>
#include <map>
#include <set>
#include <utility>

namespace lodemark {
namespace {

enum Field : int { kPoint = kFirstOwnField, kImage, kX, kY, kSigmaPixel };

constexpr ColumnName kOwnNames[] = {
    {"point", kPoint}, {"name", kPoint}, {"image", kImage}, {"x_px", kX},
    {"im_x", kX},      {"y_px", kY},     {"im_y", kY},      {"sigma_px", kSigmaPixel},
};
constexpr auto kNames = WithPlaceColumns(kOwnNames);
constexpr std::array<int, 4> kMarkFields = {kImage, kPoint, kX, kY};

constexpr double kSamePlace_m = 1e-3;
constexpr double kLargestPixel = 65'535.0;

}  // namespace

Result<std::vector<SurveyedPoint>> ReadSurveyTable(const std::string& path,
                                                   const PlaceOptions& options) {
  Result<TableRows> rows = TableRows::Open(path, kNames);
  if (!rows) return rows.error();
  const std::array<int, 1> required = {kPoint};
  const Status complete = rows->Require(required);
  if (!complete.ok()) return complete.error();
  const Result<PlaceReader> places = PlaceReader::For(*rows, options);
  if (!places) return places.error();

  std::vector<SurveyedPoint> points;
  std::map<std::string, std::size_t> index;
  while (rows->Next()) {
    SurveyedPoint point;
    point.name = rows->Text(kPoint);
    point.place = places->Read(&*rows);
    const auto [known, is_new] = index.try_emplace(point.name, points.size());
    if (is_new) {
      points.push_back(std::move(point));
    } else if ((points[known->second].place.point_m - point.place.point_m).norm() > kSamePlace_m) {
      rows->Refuse(kPoint, "point '" + point.name + "' is there twice, at different places");
    }
  }
  if (!rows->status().ok()) return rows->status().error();
  if (points.empty()) return Error{ErrorCode::kBadData, path + ": holds no point"};
  return points;
}

Result<std::vector<ImageMark>> ReadImageMarks(const std::string& path) {
  Result<TableRows> rows = TableRows::Open(path, kNames);
  if (!rows) return rows.error();
  const Status complete = rows->Require(kMarkFields);
  if (!complete.ok()) return complete.error();
  std::vector<ImageMark> marks;
  std::set<std::pair<std::string, std::string>> seen;
  while (rows->Next()) {
    ImageMark mark;
    mark.image = rows->Text(kImage);
    mark.point = rows->Text(kPoint);
    mark.x_px = rows->Number(kX, -kLargestPixel, kLargestPixel);
    mark.y_px = rows->Number(kY, -kLargestPixel, kLargestPixel);
    mark.sigma_px = rows->MaybeNumber(kSigmaPixel, 1e-3, 1e3).value_or(0.0);
    if (!seen.emplace(mark.image, mark.point).second) {
      rows->Refuse(kPoint, "the point is marked twice in this image");
    }
    marks.push_back(std::move(mark));
  }
  if (!rows->status().ok()) return rows->status().error();
  if (marks.empty()) return Error{ErrorCode::kBadData, path + ": holds no mark"};
  return marks;
}

}  // namespace lodemark
