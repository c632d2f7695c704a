// Any bytes as a packed list of descriptors, as a quantiser, and as both in one search. The first
// byte chooses; the second and third say where the quantiser ends and the list begins.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "core/map/descriptor_index.h"

namespace {

using lodemark::DescriptorKind;
using lodemark::DescriptorListView;
using lodemark::DescriptorQuantizer;

void Require(bool law) {
  if (!law) std::abort();
}

void Visit(const DescriptorQuantizer& quantizer, const DescriptorListView& view, bool exact) {
  std::array<std::uint8_t, 5 * 128> queries;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    queries[i] = static_cast<std::uint8_t>(i * i * 37);
  }
  lodemark::DescriptorSearch search(quantizer, queries, {.lists_to_visit = 2, .exact = exact});
  const std::array<Eigen::Vector3f, 3> positions = {
      Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), Eigen::Vector3f::Constant(1e30F)};
  lodemark::SearchScope scope;
  scope.landmark_positions_m = positions;
  search.Visit(-1, view, scope);
  search.Visit(quantizer.list_count(), view, scope);
  for (const int list : search.lists()) {
    search.Visit(list, view, {});
    search.Visit(list, view, scope);
  }
  for (const lodemark::NearestLandmarks& nearest : search.nearest()) {
    Require(nearest.distance <= nearest.second_distance);
    Require(nearest.landmark_id != nearest.second_landmark_id ||
            nearest.landmark_id == lodemark::NearestLandmarks::kNone);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const std::span<const std::uint8_t> bytes(data + 3, size - 3);
  const std::size_t split = std::size_t{data[1]} | std::size_t{data[2]} << 8;
  const std::size_t quantizer_size = split < bytes.size() ? split : bytes.size();
  const auto kind = (data[0] & 1) != 0 ? DescriptorKind::kOrb : DescriptorKind::kRootSift;

  const auto quantizer = DescriptorQuantizer::Parse(bytes.first(quantizer_size));
  if (quantizer) {
    const auto again = quantizer->Serialize();
    Require(again.size() == quantizer_size);
    for (std::size_t i = 0; i < again.size(); ++i) Require(again[i] == bytes[i]);
  } else {
    Require(!quantizer.error().message.empty());
  }
  const auto view = DescriptorListView::Parse(kind, bytes.subspan(quantizer_size));
  if (!view) {
    Require(!view.error().message.empty());
    return 0;
  }
  for (std::size_t i = 0; i < view->size(); ++i) {
    const float length = view->origin(i).direction_to_camera.norm();
    Require(length == 0.0F || (length > 0.999F && length < 1.001F));
    Require(view->origin(i).distance_m >= 0.0F && view->origin(i).distance_m < 1.1e6F);
    Require(view->descriptor(i) + lodemark::DescriptorBytes(kind) <= data + size);
  }
  if (quantizer && quantizer->list_count() < 100) Visit(*quantizer, *view, (data[0] & 2) != 0);
  return 0;
}
