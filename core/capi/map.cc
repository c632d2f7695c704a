// Maps, and what they say of a photograph.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/capi/check.h"
#include "core/capi/eyes.h"
#include "core/capi/guard.h"
#include "core/capi/map_handle.h"
#include "core/capi/structs.h"
#include "core/map/feature_map.h"
#include "core/session/photo_position.h"

namespace lodemark {
namespace {

static_assert(LODEMARK_DESCRIPTOR_ROOT_SIFT == static_cast<int>(DescriptorKind::kRootSift));
static_assert(LODEMARK_DESCRIPTOR_ORB == static_cast<int>(DescriptorKind::kOrb));

lodemark_map_info ToC(const MapInfo& from) {
  lodemark_map_info to = {};
  to.descriptor_kind = static_cast<std::int32_t>(from.descriptor_kind);
  to.landmarks = from.landmarks;
  to.descriptors = from.descriptors;
  to.images = from.images;
  to.building_parts = from.building_parts;
  to.origin_geodetic[0] = from.origin.latitude_rad * kDegreesPerRadian;
  to.origin_geodetic[1] = from.origin.longitude_rad * kDegreesPerRadian;
  to.origin_geodetic[2] = from.origin.height_m;
  to.epoch_year = from.epoch_year;
  CopyText(from.id.data(), from.id.size(), to.id, sizeof to.id);
  CopyText(from.datum.data(), from.datum.size(), to.datum, sizeof to.datum);
  CopyText(from.provenance.data(), from.provenance.size(), to.provenance, sizeof to.provenance);
  return to;
}

lodemark_status ReadQueryOptions(const lodemark_query_options* options, PhotoOptions* out) {
  if (options == nullptr) return LODEMARK_OK;
  lodemark_query_options stated = {};
  if (const lodemark_status status = ReadStruct(options, {"query_options"}, &stated);
      status != LODEMARK_OK) {
    return status;
  }
  Check check({"query_options"});
  check.Within(stated.most_features, 0, LODEMARK_LARGEST_COUNT, "most_features");
  check.Within(stated.longest_side_px, -1, 65'535, "longest_side_px");
  check.Within(stated.lists_to_visit, 0, 1'000'000, "lists_to_visit");
  check.Within(stated.largest_ratio, 0.0, 1.0, "largest_ratio");
  if (check.status() != LODEMARK_OK) return check.status();
  if (stated.most_features > 0) out->detector.most_features = stated.most_features;
  if (stated.longest_side_px != 0) {
    out->detector.longest_side_px = std::max(stated.longest_side_px, 0);
  }
  out->look_up.search.lists_to_visit = stated.lists_to_visit;
  if (stated.largest_ratio > 0.0) out->look_up.largest_ratio = stated.largest_ratio;
  return LODEMARK_OK;
}

// What both ways of asking a map begin with.
struct Question {
  std::optional<Lens> lens;
  GrayImage image;
  PhotoPrior prior;
  PhotoOptions options;
};

lodemark_status Read(const lodemark_map* map, const lodemark_lens* lens, const uint8_t* pixels,
                     int64_t stride_bytes, const lodemark_view_prior* prior,
                     const lodemark_query_options* options, Question* out) {
  if (map == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "map is NULL");
  lodemark_status status = ReadLens(lens, "lens", &out->lens);
  if (status == LODEMARK_OK) status = ReadPrior(prior, map->frame, &out->prior);
  if (status == LODEMARK_OK) status = ReadQueryOptions(options, &out->options);
  if (status != LODEMARK_OK) return status;
  if (pixels == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "pixels is NULL");
  const LensParameters& size = out->lens->parameters();
  if (stride_bytes < size.width_px || stride_bytes > INT32_MAX) {
    return Fail(LODEMARK_ERROR_INVALID_ARGUMENT,
                "stride_bytes is less than the width of the lens's image, or absurd");
  }
  out->image = {pixels, size.width_px, size.height_px, static_cast<std::ptrdiff_t>(stride_bytes)};
  return LODEMARK_OK;
}

std::size_t Listed(std::size_t size) { return std::min<std::size_t>(size, LODEMARK_LARGEST_COUNT); }

}  // namespace
}  // namespace lodemark

lodemark_status lodemark_map_open(const char* path, lodemark_map** map) {
  using namespace lodemark;
  return Guard([&] {
    if (map == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "map is NULL");
    *map = nullptr;
    if (path == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "path is NULL");
    Result<std::unique_ptr<FeatureMap>> opened = FeatureMap::Open(path);
    if (!opened) return Fail(opened.error());
    const EnuFrame frame((*opened)->info().origin);
    *map = new lodemark_map{std::move(*opened), frame};
    return LODEMARK_OK;
  });
}

void lodemark_map_close(lodemark_map* map) { delete map; }

lodemark_status lodemark_map_read_info(const lodemark_map* map, lodemark_map_info* info) {
  using namespace lodemark;
  return Guard([&] {
    if (map == nullptr) return Fail(LODEMARK_ERROR_INVALID_ARGUMENT, "map is NULL");
    const lodemark_status status = CheckStruct<lodemark_map_info>(info, {"info"});
    if (status != LODEMARK_OK) return status;
    WriteStruct(ToC(map->map->info()), info);
    return LODEMARK_OK;
  });
}

lodemark_status lodemark_map_query(lodemark_map* map, const lodemark_lens* lens,
                                   const uint8_t* pixels, int64_t stride_bytes,
                                   const lodemark_view_prior* prior,
                                   const lodemark_query_options* options, lodemark_sight* out,
                                   int32_t capacity, int32_t* count) {
  using namespace lodemark;
  return Guard([&] {
    Question question;
    lodemark_status status = Read(map, lens, pixels, stride_bytes, prior, options, &question);
    if (status == LODEMARK_OK) {
      status = WriteList<lodemark_sight>(
          0, [](std::size_t) { return lodemark_sight{}; }, out, capacity, count);
    }
    if (status != LODEMARK_OK) return status;
    Result<std::vector<LandmarkMatch>> matches =
        LookAtMap(*map->map, question.image, *question.lens, question.prior, question.options);
    if (!matches) return Fail(matches.error());
    return WriteList<lodemark_sight>(
        Listed(matches->size()), [&](std::size_t i) { return ToC((*matches)[i], map->frame); }, out,
        capacity, count);
  });
}

lodemark_status lodemark_map_locate(
    lodemark_map* map, const lodemark_lens* lens, const uint8_t* pixels, int64_t stride_bytes,
    const lodemark_view_prior* prior, const lodemark_query_options* query_options,
    const lodemark_resect_options* resect_options, lodemark_pose* pose, lodemark_sight* out,
    lodemark_sight_residual* residuals, int32_t capacity, int32_t* count) {
  using namespace lodemark;
  return Guard([&] {
    Question question;
    bool is_focal_known = true;
    lodemark_status status = Read(map, lens, pixels, stride_bytes, prior, query_options, &question);
    if (status == LODEMARK_OK) {
      status = ReadResectOptions(resect_options, &question.options.resection, &is_focal_known);
    }
    if (status == LODEMARK_OK && !is_focal_known) {
      return FailAt(LODEMARK_ERROR_UNSUPPORTED, {"resect_options"}, "focal",
                    "is UNKNOWN, which only lodemark_pose_resect can serve");
    }
    if (status == LODEMARK_OK) status = CheckStruct<lodemark_pose>(pose, {"pose"});
    if (status == LODEMARK_OK) {
      status = WriteList<lodemark_sight>(
          0, [](std::size_t) { return lodemark_sight{}; }, out, capacity, count);
    }
    if (status == LODEMARK_OK && residuals != nullptr && capacity > 0) {
      status = CheckStruct<lodemark_sight_residual>(residuals, {"residuals"});
    }
    if (status != LODEMARK_OK) return status;

    Result<PhotoPosition> found =
        LocatePhoto(*map->map, question.image, *question.lens, question.prior, question.options);
    if (!found) return Fail(found.error());
    WriteStruct(ToC(found->pose, question.lens->parameters(), map->frame), pose);
    const std::size_t listed = Listed(found->matches.size());
    if (residuals != nullptr) {
      const VisualRanges ranges =
          VisualRangesFrom(found->pose, SightsFrom(found->matches), *question.lens);
      const std::vector<lodemark_sight_residual> fared = SightResiduals(found->pose, ranges);
      WriteList<lodemark_sight_residual>(
          std::min(listed, fared.size()), [&](std::size_t i) { return fared[i]; }, residuals,
          capacity, count);
    }
    WriteList<lodemark_sight>(
        listed, [&](std::size_t i) { return ToC(found->matches[i], map->frame); }, out, capacity,
        count);
    return HasPose(found->pose.verdict) ? LODEMARK_OK : LODEMARK_NO_POSITION;
  });
}
