#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "core/base/random.h"
#include "core/map/descriptor_clusters.h"
#include "core/map/descriptor_codes.h"
#include "core/map/descriptor_index.h"
#include "core/map/descriptor_tables.h"

namespace lodemark {
namespace {

// Magic "LMDQ", version, kind, whether lists are coded, 0, the number of lists (four bytes), four
// bytes 0; then the centres, and the codebook if lists are coded.
constexpr std::uint8_t kMagic[4] = {'L', 'M', 'D', 'Q'};
constexpr std::uint8_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 16;

constexpr std::size_t kMostLists = 65536;
constexpr std::size_t kMostListsChosen = 16384;
constexpr std::size_t kExactSize = 20'000;

constexpr std::size_t kSamplesPerList = 48;
constexpr std::size_t kCodebookSamples = 20'000;

// Four times the square root, as a list is then about as long as a quarter of the lists are many.
std::size_t ChooseLists(std::size_t size) {
  if (size <= kExactSize) return 1;
  const double lists = 4.0 * std::sqrt(static_cast<double>(size));
  const std::size_t rounded = (static_cast<std::size_t>(lists) + 15) / 16 * 16;
  return std::min(rounded, kMostListsChosen);
}

// Descriptors drawn at random, in the order in which they lie; all if they are few.
std::vector<std::uint8_t> Sample(std::span<const std::uint8_t> descriptors, std::size_t bytes_each,
                                 std::size_t most, Random& random) {
  const std::size_t size = descriptors.size() / bytes_each;
  std::vector<std::uint8_t> sample;
  std::size_t wanted = std::min(most, size);
  sample.reserve(wanted * bytes_each);
  for (std::size_t i = 0; i < size && wanted > 0; ++i) {
    if (random.Index(size - i) >= wanted) continue;
    const std::span<const std::uint8_t> one = descriptors.subspan(i * bytes_each, bytes_each);
    sample.insert(sample.end(), one.begin(), one.end());
    --wanted;
  }
  return sample;
}

Error Damaged(std::string what) {
  return {ErrorCode::kBadData, "descriptor quantiser: " + std::move(what)};
}

}  // namespace

std::vector<DescriptorTile> TilesOf(std::span<const std::uint8_t> descriptors) {
  const std::size_t count = descriptors.size() / 128;
  std::vector<DescriptorTile> tiles((count + kTileSize - 1) / kTileSize);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    FillTile(descriptors.data() + i * kTileSize * 128, std::min(kTileSize, count - i * kTileSize),
             &tiles[i]);
  }
  return tiles;
}

DescriptorQuantizer DescriptorQuantizer::Train(DescriptorKind kind,
                                               std::span<const std::uint8_t> descriptors,
                                               const Options& options) {
  const std::size_t bytes_each = DescriptorBytes(kind);
  const std::size_t size = descriptors.size() / bytes_each;
  auto tables = std::make_shared<Tables>();
  tables->kind = kind;
  tables->lists = options.lists > 0 ? static_cast<std::size_t>(options.lists) : ChooseLists(size);
  tables->lists = std::clamp<std::size_t>(tables->lists, 1,
                                          std::min(kMostLists, std::max<std::size_t>(size, 1)));
  tables->centres.resize(tables->lists * bytes_each);
  if (tables->lists > 1) {
    Random random(options.seed);
    const std::vector<std::uint8_t> sample =
        Sample(descriptors, bytes_each, tables->lists * kSamplesPerList, random);
    tables->centres = FindCentres(kind, sample, tables->lists, random);
    if (kind == DescriptorKind::kRootSift) {
      tables->coded = true;
      const std::vector<std::uint8_t> few = Sample(sample, bytes_each, kCodebookSamples, random);
      tables->codebook =
          FindCodebook(few, tables->centres, NearestCentres(kind, few, tables->centres), random);
    }
  }
  if (kind == DescriptorKind::kRootSift) tables->tiles = TilesOf(tables->centres);
  return DescriptorQuantizer(std::move(tables));
}

std::vector<std::uint8_t> DescriptorQuantizer::Serialize() const {
  const std::size_t centre_bytes = tables_->centres.size();
  const std::size_t codebook_bytes = tables_->coded ? tables_->codebook.values.size() : 0;
  std::vector<std::uint8_t> bytes(kHeaderBytes + centre_bytes + codebook_bytes);
  std::memcpy(bytes.data(), kMagic, sizeof kMagic);
  bytes[4] = kVersion;
  bytes[5] = static_cast<std::uint8_t>(tables_->kind);
  bytes[6] = tables_->coded ? 1 : 0;
  StoreBytes(static_cast<std::uint32_t>(tables_->lists), 4, bytes.data() + 8);
  std::uint8_t* body = bytes.data() + kHeaderBytes;
  std::memcpy(body, tables_->centres.data(), centre_bytes);
  std::memcpy(body + centre_bytes, tables_->codebook.values.data(), codebook_bytes);
  return bytes;
}

Result<DescriptorQuantizer> DescriptorQuantizer::Parse(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) {
    return Damaged("is none");
  }
  if (bytes[4] != kVersion) return Damaged("version " + std::to_string(bytes[4]) + ", not 1");
  if (bytes[5] != static_cast<std::uint8_t>(DescriptorKind::kRootSift) &&
      bytes[5] != static_cast<std::uint8_t>(DescriptorKind::kOrb)) {
    return Damaged("of an unknown kind of descriptor");
  }
  auto tables = std::make_shared<Tables>();
  tables->kind = static_cast<DescriptorKind>(bytes[5]);
  tables->coded = bytes[6] == 1;
  if (bytes[6] > 1 || bytes[7] != 0 || LoadU32(bytes.data() + 12) != 0) {
    return Damaged("header has bits of no meaning");
  }
  if (tables->coded && tables->kind != DescriptorKind::kRootSift) {
    return Damaged("binary descriptors have no codes");
  }
  tables->lists = LoadU32(bytes.data() + 8);
  if (tables->lists < 1 || tables->lists > kMostLists) {
    return Damaged(std::to_string(tables->lists) + " lists");
  }
  const std::size_t centre_bytes = tables->lists * DescriptorBytes(tables->kind);
  const std::size_t codebook_bytes = tables->coded ? tables->codebook.values.size() : 0;
  if (bytes.size() != kHeaderBytes + centre_bytes + codebook_bytes) {
    return Damaged(std::to_string(bytes.size()) + " bytes, where " + std::to_string(tables->lists) +
                   " lists take " + std::to_string(kHeaderBytes + centre_bytes + codebook_bytes));
  }
  const std::span<const std::uint8_t> centres = bytes.subspan(kHeaderBytes, centre_bytes);
  tables->centres.assign(centres.begin(), centres.end());
  std::memcpy(tables->codebook.values.data(), centres.data() + centre_bytes, codebook_bytes);
  if (tables->kind == DescriptorKind::kRootSift) tables->tiles = TilesOf(tables->centres);
  return DescriptorQuantizer(std::move(tables));
}

DescriptorQuantizer::DescriptorQuantizer(std::shared_ptr<const Tables> tables)
    : tables_(std::move(tables)) {}
DescriptorQuantizer::DescriptorQuantizer(const DescriptorQuantizer&) = default;
DescriptorQuantizer::DescriptorQuantizer(DescriptorQuantizer&&) noexcept = default;
DescriptorQuantizer& DescriptorQuantizer::operator=(DescriptorQuantizer&&) noexcept = default;
DescriptorQuantizer::~DescriptorQuantizer() = default;

DescriptorKind DescriptorQuantizer::kind() const { return tables_->kind; }

int DescriptorQuantizer::list_count() const { return static_cast<int>(tables_->lists); }

int DescriptorQuantizer::ListOf(const std::uint8_t* descriptor) const {
  return ListsOf({descriptor, DescriptorBytes(tables_->kind)}).front();
}

std::vector<int> DescriptorQuantizer::ListsOf(std::span<const std::uint8_t> descriptors) const {
  std::vector<std::uint32_t> nearest(descriptors.size() / DescriptorBytes(tables_->kind));
  if (tables_->kind == DescriptorKind::kOrb) {
    NearestByBits(descriptors, tables_->centres, nearest.data());
  } else {
    NearestByTiles(descriptors, tables_->tiles, nearest.data());
  }
  return {nearest.begin(), nearest.end()};
}

}  // namespace lodemark
