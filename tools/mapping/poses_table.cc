#include "tools/mapping/poses_table.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

namespace lodemark {
namespace {

enum Field : int {
  kName,
  kQw,
  kQx,
  kQy,
  kQz,
  kTx,
  kTy,
  kTz,
  kCx,
  kCy,
  kCz,
  kFx,
  kFy,
  kPpx,
  kPpy,
  kWidth,
  kHeight,
};

constexpr ColumnName kNames[] = {
    {"name", kName},   {"qw", kQw},         {"qx", kQx}, {"qy", kQy},   {"qz", kQz},
    {"tx", kTx},       {"ty", kTy},         {"tz", kTz}, {"cx", kCx},   {"cy", kCy},
    {"cz", kCz},       {"fx", kFx},         {"fy", kFy}, {"ppx", kPpx}, {"ppy", kPpy},
    {"width", kWidth}, {"height", kHeight},
};

constexpr double kFarthest = 1e9;

// Between a centre and the one that rotation and translation give, relative to the distances: a
// pose the other way round differs by more.
constexpr double kCentreTolerance = 1e-3;

bool HasAll(const TableRows& rows, int first, int last) {
  for (int field = first; field <= last; ++field) {
    if (!rows.Has(field)) return false;
  }
  return true;
}

PosedImage ReadRow(bool has_centre, bool has_camera, TableRows* rows) {
  PosedImage image;
  image.name = rows->Text(kName);
  Eigen::Quaterniond rotation;
  rotation.w() = rows->Number(kQw, -1.01, 1.01);
  rotation.x() = rows->Number(kQx, -1.01, 1.01);
  rotation.y() = rows->Number(kQy, -1.01, 1.01);
  rotation.z() = rows->Number(kQz, -1.01, 1.01);
  if (!(std::abs(rotation.norm() - 1.0) < 0.01)) {
    rows->Refuse(kQw, "qw, qx, qy, qz are no unit quaternion");
    return image;
  }
  Eigen::Vector3d translation;
  for (int i = 0; i < 3; ++i) translation(i) = rows->Number(kTx + i, -kFarthest, kFarthest);
  image.camera_from_world = Rigid3(rotation, translation);
  if (has_centre) {
    Eigen::Vector3d centre;
    for (int i = 0; i < 3; ++i) centre(i) = rows->Number(kCx + i, -kFarthest, kFarthest);
    const Eigen::Vector3d expected = image.camera_from_world.Inverse().translation();
    if ((centre - expected).norm() > kCentreTolerance * (1.0 + centre.norm())) {
      rows->Refuse(kCx, "the centre cx, cy, cz is not where qw .. tz put it: world to camera?");
    }
  }
  if (has_camera) {
    LensParameters lens;
    lens.fx_px = rows->Number(kFx, 1e-3, 1e7);
    lens.fy_px = rows->Number(kFy, 1e-3, 1e7);
    lens.cx_px = rows->Number(kPpx, -1e6, 1e6);
    lens.cy_px = rows->Number(kPpy, -1e6, 1e6);
    lens.width_px = static_cast<int>(rows->Integer(kWidth, 1, 65'535));
    lens.height_px = static_cast<int>(rows->Integer(kHeight, 1, 65'535));
    image.pinhole = lens;
  }
  return image;
}

enum CameraField : int { kCameraName = kFirstOwnField, kCameraRole };
constexpr ColumnName kOwnCameraNames[] = {
    {"name", kCameraName}, {"image", kCameraName}, {"role", kCameraRole}};
constexpr auto kCameraNames = WithPlaceColumns(kOwnCameraNames);

}  // namespace

Result<std::vector<PosedImage>> ReadPosesTable(TableRows rows) {
  const std::array<int, 8> required = {kName, kQw, kQx, kQy, kQz, kTx, kTy, kTz};
  const Status complete = rows.Require(required);
  if (!complete.ok()) return complete.error();
  const bool has_centre = HasAll(rows, kCx, kCz);
  const bool has_camera = HasAll(rows, kFx, kHeight);
  std::vector<PosedImage> images;
  std::set<std::string> names;
  while (rows.Next()) {
    images.push_back(ReadRow(has_centre, has_camera, &rows));
    if (!names.insert(images.back().name).second) rows.Refuse(kName, "the image is there twice");
  }
  if (!rows.status().ok()) return rows.status().error();
  if (images.empty()) return Error{ErrorCode::kBadData, rows.name() + ": holds no pose"};
  return images;
}

Result<std::vector<PosedImage>> ReadPosesTable(const std::string& path) {
  Result<TableRows> rows = TableRows::Open(path, kNames);
  if (!rows) return rows.error();
  return ReadPosesTable(std::move(rows).value());
}

Result<std::vector<CameraPlace>> ReadCameraPlaces(const std::string& path,
                                                  const PlaceOptions& options) {
  Result<TableRows> rows = TableRows::Open(path, kCameraNames);
  if (!rows) return rows.error();
  const std::array<int, 1> required = {kCameraName};
  const Status complete = rows->Require(required);
  if (!complete.ok()) return complete.error();
  const Result<PlaceReader> places = PlaceReader::For(*rows, options);
  if (!places) return places.error();
  std::vector<CameraPlace> cameras;
  std::set<std::string> names;
  while (rows->Next()) {
    CameraPlace camera;
    camera.name = rows->Text(kCameraName);
    camera.role = rows->MaybeText(kCameraRole);
    camera.place = places->Read(&*rows);
    if (!names.insert(camera.name).second) rows->Refuse(kCameraName, "the image is there twice");
    cameras.push_back(std::move(camera));
  }
  if (!rows->status().ok()) return rows->status().error();
  if (cameras.empty()) return Error{ErrorCode::kBadData, path + ": holds no camera"};
  return cameras;
}

}  // namespace lodemark
