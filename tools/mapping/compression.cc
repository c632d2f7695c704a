#include "tools/mapping/compression.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace lodemark {
namespace {

constexpr int kCellsAcross = 6;    // of an image, and down
constexpr int kCellsOfSpace = 12;  // along the longest extent, where there are no images

// Worth of one landmark more, for an image or a cell that has so many. An image needs some dozens
// for a pose; a cell is served by a few.
double WorthToImage(int has) { return 20.0 / (20.0 + has); }
double WorthToCell(int has) { return 1.0 / ((1.0 + has) * (1.0 + has)); }

// What landmarks serve: images, and cells of images or of space. All counted alike, by number.
class Services {
 public:
  explicit Services(const MapContent& content) : of_landmark_(content.landmarks.size()) {
    const std::vector<std::size_t> landmark_of = LandmarkOfEach(content);
    for (std::size_t i = 0; i < content.origins.size(); ++i) {
      if (landmark_of[i] == kNoLandmark) continue;
      const std::uint32_t image = content.origins[i].image_id;
      if (image == 0) continue;
      Add(landmark_of[i], {image, -1, -1}, true);
      if (content.places_in_image.empty()) continue;
      const Eigen::Vector2f place = content.places_in_image[i] * static_cast<float>(kCellsAcross);
      const int column = std::clamp(static_cast<int>(place.x()), 0, kCellsAcross - 1);
      const int row = std::clamp(static_cast<int>(place.y()), 0, kCellsAcross - 1);
      Add(landmark_of[i], {image, column, row}, false);
    }
    AddSpace(content, landmark_of);
    had_.assign(is_image_.size(), 0);
  }

  double WorthOf(std::size_t landmark) const {
    double worth = 0.0;
    for (const std::uint32_t service : of_landmark_[landmark]) {
      worth += is_image_[service] ? WorthToImage(had_[service]) : WorthToCell(had_[service]);
    }
    return worth;
  }

  void Take(std::size_t landmark) {
    for (const std::uint32_t service : of_landmark_[landmark]) ++had_[service];
  }

 private:
  static constexpr std::size_t kNoLandmark = static_cast<std::size_t>(-1);

  static std::vector<std::size_t> LandmarkOfEach(const MapContent& content) {
    std::vector<std::size_t> landmark_of;
    landmark_of.reserve(content.origins.size());
    for (const DescriptorOrigin& origin : content.origins) {
      const auto at = std::lower_bound(
          content.landmarks.begin(), content.landmarks.end(), origin.landmark_id,
          [](const Landmark& landmark, std::uint32_t id) { return landmark.id < id; });
      const bool known = at != content.landmarks.end() && at->id == origin.landmark_id;
      landmark_of.push_back(known ? static_cast<std::size_t>(at - content.landmarks.begin())
                                  : kNoLandmark);
    }
    return landmark_of;
  }

  // Landmarks no image is known of serve their part of space, more if they were seen more often.
  void AddSpace(const MapContent& content, const std::vector<std::size_t>& landmark_of) {
    if (content.landmarks.empty()) return;
    Eigen::Vector3d least = content.landmarks.front().position_in_enu_m;
    Eigen::Vector3d greatest = least;
    for (const Landmark& landmark : content.landmarks) {
      least = least.cwiseMin(landmark.position_in_enu_m);
      greatest = greatest.cwiseMax(landmark.position_in_enu_m);
    }
    const double cell_m = std::max((greatest - least).maxCoeff(), 1e-3) / kCellsOfSpace;
    for (std::size_t i = 0; i < content.origins.size(); ++i) {
      if (landmark_of[i] == kNoLandmark || content.origins[i].image_id != 0) continue;
      const Eigen::Vector3d at =
          (content.landmarks[landmark_of[i]].position_in_enu_m - least) / cell_m;
      Add(landmark_of[i],
          {0, static_cast<int>(at.x()) * (kCellsOfSpace + 1) + static_cast<int>(at.y()),
           static_cast<int>(at.z())},
          false);
    }
  }

  void Add(std::size_t landmark, const std::tuple<std::uint32_t, int, int>& key, bool is_image) {
    const auto [at, is_new] =
        numbers_.try_emplace(key, static_cast<std::uint32_t>(is_image_.size()));
    if (is_new) is_image_.push_back(is_image);
    of_landmark_[landmark].push_back(at->second);
  }

  std::map<std::tuple<std::uint32_t, int, int>, std::uint32_t> numbers_;
  std::vector<std::vector<std::uint32_t>> of_landmark_;
  std::vector<bool> is_image_;
  std::vector<int> had_;
};

// Poorly placed landmarks pull a pose less: theirs counts less, the median's half.
std::vector<double> Trust(const std::vector<Landmark>& landmarks) {
  std::vector<double> sigmas;
  sigmas.reserve(landmarks.size());
  for (const Landmark& landmark : landmarks) {
    sigmas.push_back(std::sqrt(std::max(0.0, landmark.covariance_m2.trace())));
  }
  std::vector<double> sorted = sigmas;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median_m = std::max(*middle, 1e-9);
  std::vector<double> trust;
  trust.reserve(sigmas.size());
  for (const double sigma : sigmas) {
    const double relative = sigma / median_m;
    trust.push_back(1.0 / (1.0 + relative * relative));
  }
  return trust;
}

}  // namespace

std::vector<std::uint32_t> RankLandmarks(const MapContent& content, std::size_t count) {
  std::vector<std::uint32_t> chosen;
  if (content.landmarks.empty()) return chosen;
  Services services(content);
  const std::vector<double> trust = Trust(content.landmarks);
  // Worth only falls as others are taken, so a landmark whose worth is still what it was when it
  // came to the top is the best (Minoux 1978, accelerated greedy).
  struct Candidate {
    double worth;
    std::uint32_t index;
    bool operator<(const Candidate& other) const {
      return worth != other.worth ? worth < other.worth : index > other.index;
    }
  };
  std::priority_queue<Candidate> queue;
  for (std::size_t i = 0; i < content.landmarks.size(); ++i) {
    queue.push({trust[i] * services.WorthOf(i), static_cast<std::uint32_t>(i)});
  }
  while (chosen.size() < count && !queue.empty()) {
    Candidate top = queue.top();
    queue.pop();
    const double worth = trust[top.index] * services.WorthOf(top.index);
    if (worth < top.worth) {
      top.worth = worth;
      queue.push(top);
      continue;
    }
    services.Take(top.index);
    chosen.push_back(top.index);
  }
  return chosen;
}

void KeepBestLandmarks(double share, MapContent* content) {
  const double wanted = std::round(share * static_cast<double>(content->landmarks.size()));
  const auto count = static_cast<std::size_t>(std::max(1.0, wanted));
  std::vector<std::uint32_t> kept = RankLandmarks(*content, count);
  std::sort(kept.begin(), kept.end());
  std::vector<Landmark> landmarks;
  landmarks.reserve(kept.size());
  for (const std::uint32_t index : kept) landmarks.push_back(content->landmarks[index]);

  const std::size_t bytes =
      content->origins.empty() ? 0 : content->descriptors.size() / content->origins.size();
  std::size_t to = 0;
  for (std::size_t i = 0; i < content->origins.size(); ++i) {
    const std::uint32_t id = content->origins[i].landmark_id;
    const bool keeps =
        std::binary_search(landmarks.begin(), landmarks.end(), Landmark{id, {}, {}},
                           [](const Landmark& a, const Landmark& b) { return a.id < b.id; });
    if (!keeps) continue;
    content->origins[to] = content->origins[i];
    if (!content->places_in_image.empty()) {
      content->places_in_image[to] = content->places_in_image[i];
    }
    const auto from = content->descriptors.begin() + static_cast<std::ptrdiff_t>(i * bytes);
    std::copy(from, from + static_cast<std::ptrdiff_t>(bytes),
              content->descriptors.begin() + static_cast<std::ptrdiff_t>(to * bytes));
    ++to;
  }
  content->origins.resize(to);
  if (!content->places_in_image.empty()) content->places_in_image.resize(to);
  content->descriptors.resize(to * bytes);
  content->landmarks = std::move(landmarks);
}

}  // namespace lodemark
