#include "core/map/descriptor_codes.h"

#include <algorithm>
#include <limits>

namespace lodemark {
namespace {

constexpr int kIterations = 12;
constexpr std::size_t kPartBytes = DescriptorCodebook::kPartBytes;

using Part = std::array<std::int32_t, kPartBytes>;

Part RestOf(const std::uint8_t* descriptor, const std::uint8_t* centre, std::size_t part) {
  Part rest;
  for (std::size_t k = 0; k < kPartBytes; ++k) {
    rest[k] = descriptor[part * kPartBytes + k] - centre[part * kPartBytes + k];
  }
  return rest;
}

std::size_t NearestWord(const std::int8_t* words, const Part& rest) {
  std::size_t nearest = 0;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (std::size_t code = 0; code < kCodesPerPart; ++code) {
    std::int32_t distance = 0;
    for (std::size_t k = 0; k < kPartBytes; ++k) {
      const std::int32_t apart = rest[k] - words[code * kPartBytes + k];
      distance += apart * apart;
    }
    if (distance >= least) continue;
    least = distance;
    nearest = code;
  }
  return nearest;
}

std::int8_t RoundedMean(std::int64_t sum, std::int64_t count) {
  const std::int64_t mean = (2 * sum + (sum < 0 ? -count : count)) / (2 * count);
  return static_cast<std::int8_t>(std::clamp<std::int64_t>(mean, -127, 127));
}

void FindWords(const std::vector<Part>& rests, Random& random, std::int8_t* words) {
  const auto store = [&](std::size_t code, const Part& rest) {
    for (std::size_t k = 0; k < kPartBytes; ++k)
      words[code * kPartBytes + k] = RoundedMean(rest[k], 1);
  };
  for (std::size_t code = 0; code < kCodesPerPart; ++code) {
    store(code, rests[random.Index(rests.size())]);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    std::array<std::array<std::int64_t, kPartBytes>, kCodesPerPart> sums = {};
    std::array<std::int64_t, kCodesPerPart> counts = {};
    for (const Part& rest : rests) {
      const std::size_t code = NearestWord(words, rest);
      ++counts[code];
      for (std::size_t k = 0; k < kPartBytes; ++k) sums[code][k] += rest[k];
    }
    for (std::size_t code = 0; code < kCodesPerPart; ++code) {
      if (counts[code] == 0) {
        store(code, rests[random.Index(rests.size())]);
        continue;
      }
      for (std::size_t k = 0; k < kPartBytes; ++k) {
        words[code * kPartBytes + k] = RoundedMean(sums[code][k], counts[code]);
      }
    }
  }
}

}  // namespace

DescriptorCodebook FindCodebook(std::span<const std::uint8_t> descriptors,
                                std::span<const std::uint8_t> centres,
                                std::span<const std::uint32_t> cells, Random& random) {
  DescriptorCodebook codebook;
  if (cells.empty()) return codebook;
  std::vector<Part> rests(cells.size());
  for (std::size_t part = 0; part < kCodeParts; ++part) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      rests[i] =
          RestOf(descriptors.data() + 128 * i, centres.data() + std::size_t{128} * cells[i], part);
    }
    FindWords(rests, random, codebook.values.data() + part * kCodesPerPart * kPartBytes);
  }
  return codebook;
}

std::vector<std::uint8_t> CodesOf(const DescriptorCodebook& codebook, const std::uint8_t* centre,
                                  std::span<const std::uint8_t> descriptors) {
  const std::size_t count = descriptors.size() / 128;
  std::vector<std::uint8_t> blocks(CodeBytes(count));
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t* block = blocks.data() + i / kCodeBlockSize * kCodeBlockBytes;
    const std::size_t within = i % kCodeBlockSize;
    std::uint8_t* codes = block + 2 * kCodeBlockSize + CodeBytePosition(within);
    std::int32_t term = 0;
    for (std::size_t part = 0; part < kCodeParts; ++part) {
      const Part rest = RestOf(descriptors.data() + 128 * i, centre, part);
      const std::size_t code = NearestWord(codebook.Word(part, 0), rest);
      const std::int8_t* word = codebook.Word(part, code);
      for (std::size_t k = 0; k < kPartBytes; ++k) {
        term += word[k] * (word[k] + 2 * centre[part * kPartBytes + k]);
      }
      codes[part / 2 * kCodeBlockSize] |=
          static_cast<std::uint8_t>(part % 2 == 0 ? code : code << 4);
    }
    const std::int32_t rounded = std::clamp(term / kEstimateUnit, -32768, 32767);
    StoreBytes(static_cast<std::uint32_t>(rounded), 2, block + 2 * within);
  }
  return blocks;
}

std::int32_t FillCodeTable(const DescriptorCodebook& codebook, const std::uint8_t* query,
                           std::uint8_t* table) {
  std::int32_t offset = 0;
  for (std::size_t part = 0; part < kCodeParts; ++part) {
    std::array<std::int32_t, kCodesPerPart> values;
    for (std::size_t code = 0; code < kCodesPerPart; ++code) {
      const std::int8_t* word = codebook.Word(part, code);
      std::int32_t dot = 0;
      for (std::size_t k = 0; k < kPartBytes; ++k) dot += query[part * kPartBytes + k] * word[k];
      values[code] = -2 * dot;
    }
    const std::int32_t least = *std::min_element(values.begin(), values.end());
    for (std::size_t code = 0; code < kCodesPerPart; ++code) {
      const std::int32_t entry = (values[code] - least + kEstimateUnit / 2) / kEstimateUnit;
      table[part * kCodesPerPart + code] =
          static_cast<std::uint8_t>(std::min(entry, kLargestCodeEntry));
    }
    offset += least;
  }
  return offset / kEstimateUnit;
}

}  // namespace lodemark
