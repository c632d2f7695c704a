// Finds, among many descriptors of landmarks, the landmarks that look most like a feature.
//
// Descriptors lie in lists, one for each cell of a coarse quantiser (Jegou, Douze, Schmid 2011,
// "Product quantization for nearest neighbor search", section IV). A list is one block of bytes
// that can be searched where it lies, in a memory-mapped file: origins, the descriptors themselves,
// and 4-bit codes by which most of them are passed over (Andre, Kermarrec, Le Scouarnec 2015,
// "Cache locality is not enough").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/map/descriptor.h"

namespace lodemark {

// The coarse cells and the codes' tables, learned from a sample of descriptors.
class DescriptorQuantizer {
 public:
  struct Options {
    int lists = 0;  // 0: chosen from the number of descriptors; 1 for some 20,000 or fewer
    std::uint64_t seed = 1;
  };

  // The descriptors lie one after another. Deterministic.
  static DescriptorQuantizer Train(DescriptorKind kind, std::span<const std::uint8_t> descriptors,
                                   const Options& options);

  // The bytes of Serialize, from anywhere: an error if they could not have come from it.
  static Result<DescriptorQuantizer> Parse(std::span<const std::uint8_t> bytes);
  std::vector<std::uint8_t> Serialize() const;

  DescriptorQuantizer(const DescriptorQuantizer&);
  DescriptorQuantizer(DescriptorQuantizer&&) noexcept;
  DescriptorQuantizer& operator=(DescriptorQuantizer&&) noexcept;
  ~DescriptorQuantizer();

  DescriptorKind kind() const;
  int list_count() const;

  // The list a descriptor belongs to.
  int ListOf(const std::uint8_t* descriptor) const;

  // The same of many that lie one after another, much faster than one by one.
  std::vector<int> ListsOf(std::span<const std::uint8_t> descriptors) const;

  // One list as a block of bytes; descriptors[i] has origins[i].
  std::vector<std::uint8_t> PackList(int list, std::span<const DescriptorOrigin> origins,
                                     std::span<const std::uint8_t> descriptors) const;

  struct Tables;
  const Tables& tables() const { return *tables_; }

 private:
  explicit DescriptorQuantizer(std::shared_ptr<const Tables> tables);
  std::shared_ptr<const Tables> tables_;
};

// A packed list, looked at where it lies. Valid as long as the bytes are.
class DescriptorListView {
 public:
  // Error if the block is not of the kind, is cut short, or says more than it holds. Needs no
  // alignment of the bytes.
  static Result<DescriptorListView> Parse(DescriptorKind kind, std::span<const std::uint8_t> bytes);

  DescriptorKind kind() const { return kind_; }
  std::size_t size() const { return size_; }
  DescriptorOrigin origin(std::size_t i) const;
  const std::uint8_t* descriptor(std::size_t i) const;

  // Read by the search.
  std::uint32_t landmark_id(std::size_t i) const;
  const std::uint8_t* codes() const { return codes_; }

 private:
  DescriptorKind kind_ = DescriptorKind::kRootSift;
  std::size_t size_ = 0;
  const std::uint8_t* origins_ = nullptr;
  const std::uint8_t* descriptors_ = nullptr;
  const std::uint8_t* codes_ = nullptr;
};

// The two landmarks that look most like one feature. Distances as in descriptor.h; several
// descriptors of one landmark count once, by the nearest.
struct NearestLandmarks {
  static constexpr std::uint32_t kNone = 0xffffffffU;

  std::uint32_t landmark_id = kNone;
  std::uint32_t distance = kNone;
  std::uint32_t second_landmark_id = kNone;
  std::uint32_t second_distance = kNone;
};

// Which descriptors may be an answer.
struct SearchScope {
  // allowed[id] != 0 admits a landmark; ids beyond its end are not admitted. Empty admits all.
  std::span<const std::uint8_t> allowed_landmarks;
  // Where the camera is, as far as is known, with the places of the landmarks admitted above
  // (positions[id], map's east-north-up): descriptors seen from another side or from much nearer or
  // further are passed over. Without positions nothing is.
  std::span<const Eigen::Vector3f> landmark_positions_m;
  Eigen::Vector3f camera_in_enu_m = Eigen::Vector3f::Zero();
  float camera_sigma_m = 0.0F;
  float widest_turn_rad = 1.05F;  // between the direction seen from then and now
  float largest_zoom = 3.0F;      // ratio of the distances, either way
};

struct SearchOptions {
  int lists_to_visit =
      0;  // at most, of each query; 0: chosen so that 99 of 100 answers are the exact ones
  bool exact = false;  // compare with every descriptor in scope
};

// One photograph's search: for each query a few lists are worth visiting; each list is visited once
// for all the queries that want it.
class DescriptorSearch {
 public:
  // The queries lie one after another and must outlive the search, like the quantiser.
  DescriptorSearch(const DescriptorQuantizer& quantizer, std::span<const std::uint8_t> queries,
                   const SearchOptions& options);
  ~DescriptorSearch();
  DescriptorSearch(const DescriptorSearch&) = delete;
  DescriptorSearch& operator=(const DescriptorSearch&) = delete;

  // The lists some query wants, in the order in which to visit them.
  std::span<const int> lists() const;

  // A list of another kind of descriptor, or one that nobody wants, is passed over.
  void Visit(int list, const DescriptorListView& view, const SearchScope& scope);

  // One answer for each query, after the visits.
  std::span<const NearestLandmarks> nearest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lodemark
