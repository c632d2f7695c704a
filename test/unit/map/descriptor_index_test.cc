#include "core/map/descriptor_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/base/random.h"

namespace lodemark {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Descriptors around centres, several for each landmark.
struct Landmarks {
  Landmarks(DescriptorKind which, std::size_t count, std::size_t each, std::uint64_t seed)
      : kind(which), random(seed) {
    const std::size_t bytes_each = DescriptorBytes(kind);
    Bytes centres(200 * bytes_each);
    for (std::uint8_t& byte : centres) byte = Fresh();
    for (std::size_t i = 0; i < count; ++i) {
      Bytes looks(bytes_each);
      const std::size_t centre = random.Index(200);
      for (std::size_t k = 0; k < bytes_each; ++k) {
        looks[k] = Blurred(centres[centre * bytes_each + k], 18.0, 0.12);
      }
      for (std::size_t k = 0; k < each; ++k) {
        for (const std::uint8_t byte : looks) descriptors.push_back(Blurred(byte, 5.0, 0.03));
        origins.push_back({.landmark_id = static_cast<std::uint32_t>(7 * i + 3),
                           .image_id = static_cast<std::uint32_t>(k)});
      }
    }
  }

  std::uint8_t Fresh() {
    if (kind == DescriptorKind::kOrb) return static_cast<std::uint8_t>(random.NextBits() >> 56);
    return static_cast<std::uint8_t>(std::min(255.0, std::abs(random.Gaussian(0.0, 60.0))));
  }

  std::uint8_t Blurred(std::uint8_t byte, double sigma, double flipped) {
    if (kind == DescriptorKind::kOrb) {
      for (int bit = 0; bit < 8; ++bit) {
        if (random.Uniform() < flipped) byte = static_cast<std::uint8_t>(byte ^ 1 << bit);
      }
      return byte;
    }
    return static_cast<std::uint8_t>(std::clamp(random.Gaussian(byte, sigma), 0.0, 255.0));
  }

  // Looks like landmarks of the map, and a fifth like none.
  Bytes Queries(std::size_t count) {
    const std::size_t bytes_each = DescriptorBytes(kind);
    Bytes queries;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t like = random.Index(origins.size());
      for (std::size_t k = 0; k < bytes_each; ++k) {
        queries.push_back(i % 5 == 0 ? Fresh()
                                     : Blurred(descriptors[like * bytes_each + k], 5.0, 0.03));
      }
    }
    return queries;
  }

  DescriptorKind kind;
  Random random;
  Bytes descriptors;
  std::vector<DescriptorOrigin> origins;
};

// A quantiser with its lists.
struct Index {
  Index(const Landmarks& landmarks, int lists, std::uint64_t seed = 1)
      : quantizer(DescriptorQuantizer::Train(landmarks.kind, landmarks.descriptors,
                                             {.lists = lists, .seed = seed})) {
    const std::size_t bytes_each = DescriptorBytes(landmarks.kind);
    const std::size_t list_count = static_cast<std::size_t>(quantizer.list_count());
    std::vector<Bytes> members(list_count);
    std::vector<std::vector<DescriptorOrigin>> origins(list_count);
    const std::vector<int> list_of = quantizer.ListsOf(landmarks.descriptors);
    for (std::size_t i = 0; i < landmarks.origins.size(); ++i) {
      const std::size_t list = static_cast<std::size_t>(list_of[i]);
      const std::uint8_t* descriptor = landmarks.descriptors.data() + i * bytes_each;
      members[list].insert(members[list].end(), descriptor, descriptor + bytes_each);
      origins[list].push_back(landmarks.origins[i]);
    }
    for (std::size_t list = 0; list < list_count; ++list) {
      blocks.push_back(quantizer.PackList(static_cast<int>(list), origins[list], members[list]));
    }
  }

  std::vector<NearestLandmarks> Search(const Bytes& queries, const SearchOptions& options,
                                       const SearchScope& scope = {}) const {
    DescriptorSearch search(quantizer, queries, options);
    for (const int list : search.lists()) {
      const auto view =
          DescriptorListView::Parse(quantizer.kind(), blocks[static_cast<std::size_t>(list)]);
      EXPECT_TRUE(view.ok());
      if (view) search.Visit(list, *view, scope);
    }
    return {search.nearest().begin(), search.nearest().end()};
  }

  DescriptorQuantizer quantizer;
  std::vector<Bytes> blocks;
};

// By comparing everything with everything.
std::vector<NearestLandmarks> SearchByHand(const Landmarks& landmarks, const Bytes& queries) {
  const std::size_t bytes_each = DescriptorBytes(landmarks.kind);
  std::vector<NearestLandmarks> answers;
  for (std::size_t q = 0; q < queries.size() / bytes_each; ++q) {
    std::map<std::uint32_t, std::uint32_t> least;  // distance of each landmark
    for (std::size_t i = 0; i < landmarks.origins.size(); ++i) {
      const std::uint8_t* a = queries.data() + q * bytes_each;
      const std::uint8_t* b = landmarks.descriptors.data() + i * bytes_each;
      const std::uint32_t distance =
          landmarks.kind == DescriptorKind::kOrb ? HammingDistance(a, b) : SquaredDistance(a, b);
      const auto [at, added] = least.try_emplace(landmarks.origins[i].landmark_id, distance);
      at->second = std::min(at->second, distance);
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranked;
    for (const auto& [landmark, distance] : least) ranked.emplace_back(distance, landmark);
    std::sort(ranked.begin(), ranked.end());
    NearestLandmarks answer;
    if (!ranked.empty()) {
      answer.distance = ranked[0].first;
      answer.landmark_id = ranked[0].second;
    }
    if (ranked.size() > 1) {
      answer.second_distance = ranked[1].first;
      answer.second_landmark_id = ranked[1].second;
    }
    answers.push_back(answer);
  }
  return answers;
}

void ExpectSame(const std::vector<NearestLandmarks>& a, const std::vector<NearestLandmarks>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].landmark_id, b[i].landmark_id);
    EXPECT_EQ(a[i].distance, b[i].distance);
    EXPECT_EQ(a[i].second_landmark_id, b[i].second_landmark_id);
    EXPECT_EQ(a[i].second_distance, b[i].second_distance);
  }
}

struct Recall {
  double nearest = 0.0;
  double both = 0.0;
};

// Of the queries that look like a landmark.
Recall RecallOf(const std::vector<NearestLandmarks>& found,
                const std::vector<NearestLandmarks>& exact) {
  Recall recall;
  double asked = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (i % 5 == 0) continue;
    asked += 1.0;
    if (found[i].landmark_id != exact[i].landmark_id) continue;
    recall.nearest += 1.0;
    if (found[i].second_landmark_id == exact[i].second_landmark_id) recall.both += 1.0;
  }
  return {recall.nearest / asked, recall.both / asked};
}

class DescriptorSearchOf : public testing::TestWithParam<DescriptorKind> {};

TEST_P(DescriptorSearchOf, ExactIsTheLoopOverEverything) {
  Landmarks landmarks(GetParam(), 700, 3, 1);
  const Bytes queries = landmarks.Queries(90);
  const std::vector<NearestLandmarks> expected = SearchByHand(landmarks, queries);
  ExpectSame(Index(landmarks, 0).Search(queries, {}), expected);  // few enough for one list
  ExpectSame(Index(landmarks, 1).Search(queries, {.exact = true}), expected);
  ExpectSame(Index(landmarks, 37).Search(queries, {.exact = true}), expected);
  ExpectSame(Index(landmarks, 37).Search(queries, {.lists_to_visit = 37}), expected);
}

TEST_P(DescriptorSearchOf, EquallyNearLandmarksRankByTheirIds) {
  Landmarks landmarks(GetParam(), 60, 1, 2);
  const std::size_t bytes_each = DescriptorBytes(GetParam());
  const Bytes again = landmarks.descriptors;
  landmarks.descriptors.insert(landmarks.descriptors.end(), again.begin(), again.end());
  for (std::uint32_t i = 0; i < 60; ++i) {
    landmarks.origins.push_back({.landmark_id = 7 * (59 - i) + 1});  // ids in another order
  }
  const Bytes queries(again.begin(), again.begin() + static_cast<std::ptrdiff_t>(40 * bytes_each));
  const std::vector<NearestLandmarks> expected = SearchByHand(landmarks, queries);
  EXPECT_EQ(expected[0].distance, expected[0].second_distance);
  EXPECT_LT(expected[0].landmark_id, expected[0].second_landmark_id);
  ExpectSame(Index(landmarks, 1).Search(queries, {}), expected);
  ExpectSame(Index(landmarks, 9).Search(queries, {.exact = true}), expected);
}

TEST_P(DescriptorSearchOf, AFewListsGiveNearlyTheExactAnswers) {
  Landmarks landmarks(GetParam(), 4'000, 2, 3);
  const Bytes queries = landmarks.Queries(500);
  const Index index(landmarks, 250);
  const std::vector<NearestLandmarks> exact = index.Search(queries, {.exact = true});
  const Recall recall = RecallOf(index.Search(queries, {}), exact);
  EXPECT_GE(recall.nearest, 0.99);
  EXPECT_GE(recall.both, 0.9);
}

TEST_P(DescriptorSearchOf, FewerListsAreVisitedWhenFewerAreAsked) {
  Landmarks landmarks(GetParam(), 2'000, 1, 4);
  const Bytes queries = landmarks.Queries(3);
  const Index index(landmarks, 100);
  DescriptorSearch one(index.quantizer, queries, {.lists_to_visit = 1});
  EXPECT_LE(one.lists().size(), 3U);
  EXPECT_GE(one.lists().size(), 1U);
  DescriptorSearch all(index.quantizer, queries, {.exact = true});
  EXPECT_EQ(all.lists().size(), 100U);
}

TEST_P(DescriptorSearchOf, OnlyAdmittedLandmarksAnswer) {
  Landmarks landmarks(GetParam(), 600, 2, 5);
  const Bytes queries = landmarks.Queries(60);
  Bytes allowed(7 * 300, 0);  // the ids above belong to landmarks that nobody admitted
  Landmarks admitted = landmarks;
  admitted.descriptors.clear();
  admitted.origins.clear();
  const std::size_t bytes_each = DescriptorBytes(GetParam());
  for (std::size_t i = 0; i < landmarks.origins.size(); ++i) {
    const std::uint32_t id = landmarks.origins[i].landmark_id;
    if (id >= allowed.size() || id % 2 == 0) continue;
    allowed[id] = 1;
    const std::uint8_t* from = landmarks.descriptors.data() + i * bytes_each;
    admitted.descriptors.insert(admitted.descriptors.end(), from, from + bytes_each);
    admitted.origins.push_back(landmarks.origins[i]);
  }
  const std::vector<NearestLandmarks> expected = SearchByHand(admitted, queries);
  SearchScope scope;
  scope.allowed_landmarks = allowed;
  ExpectSame(Index(landmarks, 1).Search(queries, {}, scope), expected);
  const Index index(landmarks, 20);
  ExpectSame(index.Search(queries, {.exact = true}, scope), expected);
  for (const NearestLandmarks& answer : index.Search(queries, {.lists_to_visit = 8}, scope)) {
    for (const std::uint32_t id : {answer.landmark_id, answer.second_landmark_id}) {
      EXPECT_TRUE(id == NearestLandmarks::kNone || (id < allowed.size() && allowed[id] == 1));
    }
  }
}

TEST_P(DescriptorSearchOf, TrainingAndSearchingRepeatToTheLastBit) {
  Landmarks landmarks(GetParam(), 1'500, 2, 6);
  const Bytes queries = landmarks.Queries(50);
  const Index a(landmarks, 40, 9);
  const Index b(landmarks, 40, 9);
  EXPECT_EQ(a.quantizer.Serialize(), b.quantizer.Serialize());
  EXPECT_EQ(a.blocks, b.blocks);
  ExpectSame(a.Search(queries, {.lists_to_visit = 5}), b.Search(queries, {.lists_to_visit = 5}));
  EXPECT_NE(Index(landmarks, 40, 10).quantizer.Serialize(), a.quantizer.Serialize());
}

TEST_P(DescriptorSearchOf, NothingToFindIsNoHarm) {
  Landmarks landmarks(GetParam(), 50, 1, 7);
  const Bytes queries = landmarks.Queries(4);
  EXPECT_TRUE(Index(landmarks, 5).Search({}, {}).empty());
  const Landmarks none(GetParam(), 0, 0, 8);
  for (const NearestLandmarks& answer : Index(none, 12).Search(queries, {})) {
    EXPECT_EQ(answer.landmark_id, NearestLandmarks::kNone);
    EXPECT_EQ(answer.second_distance, NearestLandmarks::kNone);
  }
  const Landmarks single(GetParam(), 1, 4, 9);
  for (const NearestLandmarks& answer : Index(single, 2).Search(queries, {})) {
    EXPECT_EQ(answer.landmark_id, 3U);
    EXPECT_EQ(answer.second_landmark_id, NearestLandmarks::kNone);
  }
}

TEST_P(DescriptorSearchOf, AQuantizerComesBackFromItsBytes) {
  Landmarks landmarks(GetParam(), 900, 1, 10);
  const Index index(landmarks, 30);
  const Bytes bytes = index.quantizer.Serialize();
  const Result<DescriptorQuantizer> back = DescriptorQuantizer::Parse(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back->Serialize(), bytes);
  EXPECT_EQ(back->kind(), GetParam());
  EXPECT_EQ(back->list_count(), 30);
  EXPECT_EQ(back->ListsOf(landmarks.descriptors), index.quantizer.ListsOf(landmarks.descriptors));
  const std::size_t bytes_each = DescriptorBytes(GetParam());
  for (std::size_t i = 0; i < 20; ++i) {
    const std::uint8_t* descriptor = landmarks.descriptors.data() + i * bytes_each;
    EXPECT_EQ(back->ListOf(descriptor), index.quantizer.ListsOf(landmarks.descriptors)[i]);
  }
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 9) {
    EXPECT_FALSE(DescriptorQuantizer::Parse(std::span(bytes).first(size)).ok()) << size;
  }
  Bytes many = bytes;
  std::fill_n(many.begin() + 8, 4, std::uint8_t{255});
  EXPECT_FALSE(DescriptorQuantizer::Parse(many).ok());
}

INSTANTIATE_TEST_SUITE_P(Kinds, DescriptorSearchOf,
                         testing::Values(DescriptorKind::kRootSift, DescriptorKind::kOrb),
                         [](const auto& of) {
                           return of.param == DescriptorKind::kOrb ? "Orb" : "RootSift";
                         });

}  // namespace
}  // namespace lodemark
