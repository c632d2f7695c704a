#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "core/map/descriptor_codes.h"
#include "core/map/descriptor_index.h"
#include "core/map/descriptor_scope.h"
#include "core/map/descriptor_shortlist.h"
#include "core/map/descriptor_tables.h"

namespace lodemark {
namespace {

constexpr std::uint32_t kFarthest = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kTogether = 64;         // queries compared with a tile at a time
constexpr std::size_t kBinaryTogether = 256;  // binary descriptors compared with a query at a time

constexpr std::size_t kListsToVisit = 26;
// A list whose centre is further away than the nearest one's by more than this, in squared distance
// and tenths, hardly ever holds the answer: of the lists in reach it leaves out a quarter.
constexpr std::uint64_t kFurthestListTenths = 17;
constexpr std::size_t kBinaryListsToVisit = 64;

// A query that wants a list, and how far from its centre it lies.
struct Want {
  std::uint32_t query = 0;
  std::uint32_t distance = 0;
};

// The nearest few lists of one query: distance in the high half, list in the low. Collects more
// than it needs and sheds the rest now and then.
class NearestLists {
 public:
  explicit NearestLists(std::size_t wanted) : wanted_(wanted), keys_(4 * wanted) {}

  void Clear() {
    size_ = 0;
    limit_ = kFarthest;
    least_ = kFarthest;
  }
  std::uint32_t limit() const { return limit_; }

  void Add(std::uint32_t distance, std::uint32_t list) {
    if (distance < least_) {
      least_ = distance;
      Lower(least_ * kFurthestListTenths / 10);
    }
    keys_[size_++] = static_cast<std::uint64_t>(distance) << 32 | list;
    if (size_ == keys_.size()) Shed();
  }

  std::span<const std::uint64_t> Finish() {
    if (size_ > wanted_) Shed();
    const auto far = [&](std::uint64_t key) { return key >> 32 > limit_; };
    const auto last = keys_.begin() + static_cast<std::ptrdiff_t>(size_);
    size_ = static_cast<std::size_t>(std::remove_if(keys_.begin(), last, far) - keys_.begin());
    return {keys_.data(), size_};
  }

 private:
  void Shed() {
    const auto last = keys_.begin() + static_cast<std::ptrdiff_t>(wanted_ - 1);
    std::nth_element(keys_.begin(), last, keys_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ = wanted_;
    Lower(*last >> 32);
  }

  void Lower(std::uint64_t limit) {
    if (limit < limit_) limit_ = static_cast<std::uint32_t>(limit);
  }

  std::size_t wanted_;
  std::size_t size_ = 0;
  std::uint32_t limit_ = kFarthest;
  std::uint32_t least_ = kFarthest;
  std::vector<std::uint64_t> keys_;
};

}  // namespace

struct DescriptorSearch::State {
  State(const DescriptorQuantizer& quantizer, std::span<const std::uint8_t> all_queries,
        const SearchOptions& options);

  void WantAll();
  void WantNearest(std::size_t lists_each);
  void NearestOfTiles(std::size_t first, std::span<NearestLists> nearest_lists);
  void NearestOfBits(std::size_t first, std::span<NearestLists> nearest_lists);
  void FillCodeTables();

  void VisitByTiles(const DescriptorListView& view);
  void CompareWithTile(std::span<const std::uint32_t> landmarks);
  void VisitByBits(std::span<const Want> who, const DescriptorListView& view);
  void VisitOneByOne(std::span<const Want> who, const DescriptorListView& view);
  void VisitByCodes(std::span<const Want> who, const DescriptorListView& view);

  const std::uint8_t* Query(std::size_t i) const { return queries.data() + i * bytes_each; }

  const DescriptorKernels& kernels = FastestKernels();
  const DescriptorQuantizer::Tables& tables;
  std::span<const std::uint8_t> queries;
  std::size_t bytes_each = 0;
  std::size_t count = 0;
  bool exact = false;

  std::vector<int> lists;
  std::vector<std::uint32_t> starts;  // of each list's wants, and the end; empty if exact
  std::vector<Want> wants;
  std::vector<NearestLandmarks> nearest;

  std::vector<std::int32_t> terms;         // for tiles
  std::vector<std::uint32_t> limits;       // for tiles, when exact
  std::vector<std::uint8_t> code_tables;   // of each query
  std::vector<std::int32_t> code_offsets;  // what to add to an estimate, without the centre
  std::vector<Shortlist> shortlists;

  // Kept for their room.
  DescriptorScope scope;
  std::vector<NearCode> near;
  std::vector<std::uint32_t> distances;
  std::vector<std::uint16_t> within;
  DescriptorTile tile;
};

DescriptorSearch::State::State(const DescriptorQuantizer& quantizer,
                               std::span<const std::uint8_t> all_queries,
                               const SearchOptions& options)
    : tables(quantizer.tables()), bytes_each(DescriptorBytes(quantizer.kind())) {
  count = all_queries.size() / bytes_each;
  queries = all_queries.first(count * bytes_each);
  nearest.resize(count);
  const bool binary = tables.kind == DescriptorKind::kOrb;
  distances.resize(std::max(kTogether * kTileSize, kBinaryTogether));
  within.resize(kTogether);
  if (!binary) {
    terms.resize(count);
    for (std::size_t i = 0; i < count; ++i) terms[i] = QueryTerm(Query(i));
  }
  std::size_t lists_each = binary ? kBinaryListsToVisit : kListsToVisit;
  if (options.lists_to_visit > 0) lists_each = static_cast<std::size_t>(options.lists_to_visit);
  exact = options.exact || lists_each >= tables.lists;
  limits.assign(exact ? count : kTogether, kFarthest);
  if (count == 0) return;
  if (exact) {
    WantAll();
  } else {
    WantNearest(lists_each);
    if (tables.coded) FillCodeTables();
  }
}

void DescriptorSearch::State::WantAll() {
  lists.resize(tables.lists);
  std::iota(lists.begin(), lists.end(), 0);
}

void DescriptorSearch::State::WantNearest(std::size_t lists_each) {
  std::vector<Want> found;  // in the order of the queries, with the list of each below
  std::vector<std::uint32_t> found_list;
  found.reserve(count * lists_each);
  found_list.reserve(count * lists_each);
  starts.assign(tables.lists + 1, 0);
  std::vector<NearestLists> nearest_lists(std::min(count, kTogether), NearestLists(lists_each));
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::span<NearestLists> here(nearest_lists.data(), std::min(kTogether, count - first));
    for (NearestLists& one : here) one.Clear();
    if (tables.kind == DescriptorKind::kOrb) {
      NearestOfBits(first, here);
    } else {
      NearestOfTiles(first, here);
    }
    for (std::size_t i = 0; i < here.size(); ++i) {
      for (const std::uint64_t key : here[i].Finish()) {
        const std::uint32_t list = static_cast<std::uint32_t>(key);
        found.push_back(
            {static_cast<std::uint32_t>(first + i), static_cast<std::uint32_t>(key >> 32)});
        found_list.push_back(list);
        ++starts[list + 1];
      }
    }
  }
  for (std::size_t list = 0; list < tables.lists; ++list) {
    if (starts[list + 1] > 0) lists.push_back(static_cast<int>(list));
    starts[list + 1] += starts[list];
  }
  wants.resize(found.size());
  std::vector<std::uint32_t> next(starts.begin(), starts.end() - 1);
  for (std::size_t i = 0; i < found.size(); ++i) wants[next[found_list[i]]++] = found[i];
}

void DescriptorSearch::State::NearestOfTiles(std::size_t first,
                                             std::span<NearestLists> nearest_lists) {
  for (std::size_t i = 0; i < tables.tiles.size(); ++i) {
    for (std::size_t k = 0; k < nearest_lists.size(); ++k) limits[k] = nearest_lists[k].limit();
    kernels.tile_distances(
        tables.tiles[i], {Query(first), terms.data() + first, limits.data(), nearest_lists.size()},
        {distances.data(), kTileSize, within.data()});
    const std::size_t real = std::min(kTileSize, tables.lists - i * kTileSize);
    const unsigned in_use = (1U << real) - 1U;
    for (std::size_t k = 0; k < nearest_lists.size(); ++k) {
      for (unsigned left = within[k] & in_use; left != 0; left &= left - 1U) {
        const unsigned at = static_cast<unsigned>(std::countr_zero(left));
        nearest_lists[k].Add(distances[k * kTileSize + at],
                             static_cast<std::uint32_t>(i * kTileSize + at));
      }
    }
  }
}

void DescriptorSearch::State::NearestOfBits(std::size_t first,
                                            std::span<NearestLists> nearest_lists) {
  for (std::size_t from = 0; from < tables.lists; from += kBinaryTogether) {
    const std::size_t here = std::min(kBinaryTogether, tables.lists - from);
    for (std::size_t k = 0; k < nearest_lists.size(); ++k) {
      kernels.hamming_distances(Query(first + k), tables.Centre(from), here, distances.data());
      for (std::size_t i = 0; i < here; ++i) {
        if (distances[i] > nearest_lists[k].limit()) continue;
        nearest_lists[k].Add(distances[i], static_cast<std::uint32_t>(from + i));
      }
    }
  }
}

void DescriptorSearch::State::FillCodeTables() {
  code_tables.resize(count * kCodeTableBytes);
  code_offsets.resize(count);
  shortlists.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    code_offsets[i] =
        FillCodeTable(tables.codebook, Query(i), code_tables.data() + i * kCodeTableBytes);
  }
}

void DescriptorSearch::State::VisitByTiles(const DescriptorListView& view) {
  std::array<std::uint8_t, 128 * kTileSize> together;
  std::array<std::uint32_t, kTileSize> landmarks;
  std::size_t held = 0;
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!scope.Admits(i)) continue;
    std::copy_n(view.descriptor(i), 128, together.data() + 128 * held);
    landmarks[held++] = view.landmark_id(i);
    if (held < kTileSize) continue;
    FillTile(together.data(), held, &tile);
    CompareWithTile(landmarks);
    held = 0;
  }
  if (held == 0) return;
  FillTile(together.data(), held, &tile);
  CompareWithTile({landmarks.data(), held});
}

void DescriptorSearch::State::CompareWithTile(std::span<const std::uint32_t> landmarks) {
  const unsigned in_use = (1U << landmarks.size()) - 1U;
  for (std::size_t first = 0; first < count; first += kTogether) {
    const std::size_t here = std::min(kTogether, count - first);
    kernels.tile_distances(tile, {Query(first), terms.data() + first, limits.data() + first, here},
                           {distances.data(), kTileSize, within.data()});
    for (std::size_t k = 0; k < here; ++k) {
      unsigned left = within[k] & in_use;
      if (left == 0) continue;
      for (; left != 0; left &= left - 1U) {
        const unsigned at = static_cast<unsigned>(std::countr_zero(left));
        Offer(landmarks[at], distances[k * kTileSize + at], &nearest[first + k]);
      }
      limits[first + k] = nearest[first + k].second_distance;
    }
  }
}

void DescriptorSearch::State::VisitByBits(std::span<const Want> who,
                                          const DescriptorListView& view) {
  for (std::size_t from = 0; from < view.size(); from += kBinaryTogether) {
    const std::size_t here = std::min(kBinaryTogether, view.size() - from);
    const auto compare = [&](std::size_t query) {
      kernels.hamming_distances(Query(query), view.descriptor(from), here, distances.data());
      for (std::size_t i = 0; i < here; ++i) {
        if (distances[i] > nearest[query].second_distance || !scope.Admits(from + i)) continue;
        Offer(view.landmark_id(from + i), distances[i], &nearest[query]);
      }
    };
    if (exact) {
      for (std::size_t query = 0; query < count; ++query) compare(query);
    } else {
      for (const Want& want : who) compare(want.query);
    }
  }
}

void DescriptorSearch::State::VisitOneByOne(std::span<const Want> who,
                                            const DescriptorListView& view) {
  for (const Want& want : who) {
    for (std::size_t i = 0; i < view.size(); ++i) {
      if (!scope.Admits(i)) continue;
      Offer(view.landmark_id(i), kernels.squared_distance(Query(want.query), view.descriptor(i)),
            &nearest[want.query]);
    }
  }
}

void DescriptorSearch::State::VisitByCodes(std::span<const Want> who,
                                           const DescriptorListView& view) {
  if (near.size() < view.size()) near.resize(view.size());
  for (const Want& want : who) {
    Shortlist& shortlist = shortlists[want.query];
    const std::int32_t offset =
        code_offsets[want.query] + static_cast<std::int32_t>(want.distance / kEstimateUnit);
    const std::int64_t limit = std::int64_t{shortlist.limit()} - offset;
    const std::size_t found = kernels.near_codes(
        view.codes(), view.size(), code_tables.data() + want.query * kCodeTableBytes,
        static_cast<std::int32_t>(std::clamp<std::int64_t>(limit, -40'000, 40'000)), near.data());
    for (std::size_t i = 0; i < found; ++i) {
      const std::int32_t estimate = near[i].estimate + offset;
      if (estimate >= shortlist.limit() || !scope.Admits(near[i].index)) continue;
      const std::uint32_t landmark = view.landmark_id(near[i].index);
      shortlist.Enter(landmark, estimate);
      Offer(landmark, kernels.squared_distance(Query(want.query), view.descriptor(near[i].index)),
            &nearest[want.query]);
    }
  }
}

DescriptorSearch::DescriptorSearch(const DescriptorQuantizer& quantizer,
                                   std::span<const std::uint8_t> queries,
                                   const SearchOptions& options)
    : state_(std::make_unique<State>(quantizer, queries, options)) {}

DescriptorSearch::~DescriptorSearch() = default;

std::span<const int> DescriptorSearch::lists() const { return state_->lists; }

void DescriptorSearch::Visit(int list, const DescriptorListView& view, const SearchScope& scope) {
  State& state = *state_;
  if (list < 0 || static_cast<std::size_t>(list) >= state.tables.lists || state.count == 0) return;
  if (view.kind() != state.tables.kind) return;
  std::span<const Want> who;
  if (!state.exact) {
    const std::size_t at = static_cast<std::size_t>(list);
    who = std::span<const Want>(state.wants)
              .subspan(state.starts[at], state.starts[at + 1] - state.starts[at]);
    if (who.empty()) return;
  }
  state.scope.Enter(scope, view);
  if (state.tables.kind == DescriptorKind::kOrb) {
    state.VisitByBits(who, view);
  } else if (state.exact) {
    state.VisitByTiles(view);
  } else if (state.tables.coded && view.codes() != nullptr) {
    state.VisitByCodes(who, view);
  } else {
    state.VisitOneByOne(who, view);
  }
}

std::span<const NearestLandmarks> DescriptorSearch::nearest() const { return state_->nearest; }

}  // namespace lodemark
