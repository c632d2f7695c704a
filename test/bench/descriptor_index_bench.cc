// Processor time, recall and size of the look-up of descriptors, on descriptors of a file:
//
//   descriptor_index_bench DESCRIPTORS QUERIES [--kind orb] [--most N] [--lists N] [--visit N,N...]
//
// Both files are raw bytes, 128 a descriptor (32 for ORB). Recall is of the matches of the exact
// search: queries whose nearest is nearer than 0.8 times the second.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "core/map/descriptor_index.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

// Of the processor, which others may be using as well.
double Seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Bytes Read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// One landmark for each descriptor.
std::vector<Bytes> Pack(const lodemark::DescriptorQuantizer& quantizer, const Bytes& descriptors) {
  const std::size_t bytes_each = lodemark::DescriptorBytes(quantizer.kind());
  const std::vector<int> lists = quantizer.ListsOf(descriptors);
  const std::size_t list_count = static_cast<std::size_t>(quantizer.list_count());
  std::vector<Bytes> members(list_count);
  std::vector<std::vector<lodemark::DescriptorOrigin>> origins(list_count);
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const std::size_t list = static_cast<std::size_t>(lists[i]);
    const auto from = descriptors.begin() + static_cast<std::ptrdiff_t>(i * bytes_each);
    members[list].insert(members[list].end(), from, from + static_cast<std::ptrdiff_t>(bytes_each));
    origins[list].push_back({.landmark_id = static_cast<std::uint32_t>(i)});
  }
  std::vector<Bytes> blocks;
  for (std::size_t list = 0; list < list_count; ++list) {
    blocks.push_back(quantizer.PackList(static_cast<int>(list), origins[list], members[list]));
  }
  return blocks;
}

struct Run {
  std::vector<lodemark::NearestLandmarks> nearest;
  double choosing_s = 0.0;
  double visiting_s = 0.0;
};

Run Search(const lodemark::DescriptorQuantizer& quantizer, const std::vector<Bytes>& blocks,
           const Bytes& queries, const lodemark::SearchOptions& options) {
  Run run;
  const double start_s = Seconds();
  lodemark::DescriptorSearch search(quantizer, queries, options);
  run.choosing_s = Seconds() - start_s;
  for (const int list : search.lists()) {
    const auto view = lodemark::DescriptorListView::Parse(quantizer.kind(),
                                                          blocks[static_cast<std::size_t>(list)]);
    if (view) search.Visit(list, *view, {});
  }
  run.visiting_s = Seconds() - start_s - run.choosing_s;
  run.nearest.assign(search.nearest().begin(), search.nearest().end());
  return run;
}

// 0.8 in distance: 0.64 in squared distance; bits differ like squared distances do.
bool IsMatch(const lodemark::NearestLandmarks& nearest, double ratio) {
  return nearest.second_distance != lodemark::NearestLandmarks::kNone &&
         nearest.distance < ratio * nearest.second_distance;
}

void Report(const std::string& name, const Run& run, const Run& exact, double ratio) {
  std::size_t matches = 0;
  std::size_t found = 0;
  std::size_t same_nearest = 0;
  std::size_t others = 0;
  for (std::size_t i = 0; i < run.nearest.size(); ++i) {
    const bool same = run.nearest[i].landmark_id == exact.nearest[i].landmark_id;
    const bool match = IsMatch(exact.nearest[i], ratio);
    same_nearest += same ? 1 : 0;
    matches += match ? 1 : 0;
    found += match && same && IsMatch(run.nearest[i], ratio) ? 1 : 0;
    others += !match && IsMatch(run.nearest[i], ratio) ? 1 : 0;
  }
  std::printf(
      "%-12s %8.1f ms (%6.1f + %6.1f)  recall %.4f of %zu, %zu more; nearest %.4f\n", name.c_str(),
      1e3 * (run.choosing_s + run.visiting_s), 1e3 * run.choosing_s, 1e3 * run.visiting_s,
      matches > 0 ? static_cast<double>(found) / static_cast<double>(matches) : 0.0, matches,
      others, static_cast<double>(same_nearest) / static_cast<double>(run.nearest.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr,
                 "usage: %s DESCRIPTORS QUERIES [--kind orb] [--most N] [--lists N] "
                 "[--visit N,N...]\n",
                 argv[0]);
    return 1;
  }
  auto kind = lodemark::DescriptorKind::kRootSift;
  std::size_t most = SIZE_MAX;
  lodemark::DescriptorQuantizer::Options options;
  std::string visits = "0";
  for (int i = 3; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i];
    if (name == "--kind" && std::string_view(argv[i + 1]) == "orb") {
      kind = lodemark::DescriptorKind::kOrb;
    }
    if (name == "--most") most = std::strtoull(argv[i + 1], nullptr, 10);
    if (name == "--lists") options.lists = std::atoi(argv[i + 1]);
    if (name == "--visit") visits = argv[i + 1];
  }
  const std::size_t bytes_each = lodemark::DescriptorBytes(kind);
  Bytes descriptors = Read(argv[1]);
  const Bytes queries = Read(argv[2]);
  const std::size_t size = std::min(most, descriptors.size() / bytes_each);
  if (size == 0 || queries.size() < bytes_each) {
    std::fprintf(stderr, "nothing to look up\n");
    return 1;
  }
  descriptors.resize(size * bytes_each);

  const double start_s = Seconds();
  const auto quantizer = lodemark::DescriptorQuantizer::Train(kind, descriptors, options);
  const double trained_s = Seconds();
  const std::vector<Bytes> blocks = Pack(quantizer, descriptors);
  const double packed_s = Seconds();
  std::size_t bytes = 0;
  for (const Bytes& block : blocks) bytes += block.size();
  std::printf(
      "%zu descriptors, %zu queries; %d lists, trained in %.1f s, packed in %.1f s, "
      "%.1f bytes each\n",
      size, queries.size() / bytes_each, quantizer.list_count(), trained_s - start_s,
      packed_s - trained_s, static_cast<double>(bytes) / static_cast<double>(size));

  const double ratio = kind == lodemark::DescriptorKind::kOrb ? 0.8 : 0.64;
  const Run exact = Search(quantizer, blocks, queries, {.exact = true});
  Report("exact", exact, exact, ratio);
  for (const char* at = visits.c_str(); *at != '\0';) {
    char* end = nullptr;
    const int lists = static_cast<int>(std::strtol(at, &end, 10));
    Run best;
    for (int repeat = 0; repeat < 5; ++repeat) {
      Run run = Search(quantizer, blocks, queries, {.lists_to_visit = lists});
      const double run_s = run.choosing_s + run.visiting_s;
      if (repeat == 0 || run_s < best.choosing_s + best.visiting_s) best = std::move(run);
    }
    Report("visit " + std::to_string(lists), best, exact, ratio);
    at = *end == ',' ? end + 1 : end;
    if (end == at && *end != '\0') break;
  }
  return 0;
}
