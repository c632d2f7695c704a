#include "core/vision/look_up.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "test/unit/vision/look_up_scene.h"

namespace lodemark {
namespace {

using test::AddFeature;
using test::Look;
using test::LookingNorth;
using test::MapDraft;
using test::PlaceAhead;
using test::RandomLook;
using test::SceneLens;
using test::SeenAgain;

constexpr DescriptorKind kSift = DescriptorKind::kRootSift;
constexpr std::uint32_t kLandmarks = 250;

// Landmark i lies ahead and is feature i; 100 more features are of nothing in the map.
struct Street {
  explicit Street(DescriptorKind kind) : draft(kind) {
    features.kind = kind;
    for (std::uint32_t id = 0; id < kLandmarks; ++id) {
      places.push_back(PlaceAhead(random));
      looks.push_back(RandomLook(kind, random));
      draft.Add(id, places[id],
                {SeenAgain(kind, looks[id], random), SeenAgain(kind, looks[id], random)});
      const Eigen::Vector2d pixel = *SceneLens().Project(LookingNorth() * places[id]);
      AddFeature(pixel, SeenAgain(kind, looks[id], random), &features);
    }
    for (int i = 0; i < 100; ++i) {
      AddFeature({random.Uniform(0.0, 639.0), random.Uniform(0.0, 479.0)}, RandomLook(kind, random),
                 &features);
    }
  }

  // Other landmarks that look like those ahead: at a place made from theirs, seen from another.
  template <typename Place>
  void AddTwins(Place&& place_of, const Eigen::Vector3d& seen_from_m) {
    for (std::uint32_t id = 0; id < kLandmarks; ++id) {
      draft.Add(1000 + id, place_of(places[id]), {SeenAgain(features.kind, looks[id], random)},
                seen_from_m);
    }
  }

  Random random{11};
  MapDraft draft;
  std::vector<Eigen::Vector3d> places;
  std::vector<Look> looks;
  Features features;
};

std::vector<LandmarkMatch> Find(const FeatureMap& map, const Features& features,
                                const std::optional<ViewPrior>& prior = {},
                                const LookUpOptions& options = {}) {
  Result<std::vector<LandmarkMatch>> matches = LookUp(map, features, SceneLens(), prior, options);
  EXPECT_TRUE(matches.ok()) << (matches ? "" : matches.error().message);
  return matches ? std::move(*matches) : std::vector<LandmarkMatch>{};
}

ViewPrior AtOrigin() {
  ViewPrior prior;
  prior.position_covariance_m2 = Eigen::Matrix3d::Identity();
  return prior;
}

int Right(const std::vector<LandmarkMatch>& matches) {
  return static_cast<int>(
      std::count_if(matches.begin(), matches.end(),
                    [](const LandmarkMatch& match) { return match.feature == match.landmark.id; }));
}

void ExpectNothingTwiceBestFirst(const std::vector<LandmarkMatch>& matches) {
  std::set<std::uint32_t> features;
  std::set<std::uint32_t> landmarks;
  for (const LandmarkMatch& match : matches) {
    EXPECT_TRUE(features.insert(match.feature).second);
    EXPECT_TRUE(landmarks.insert(match.landmark.id).second);
    EXPECT_GT(match.pixel_sigma_px, 0.0);
  }
  EXPECT_TRUE(std::is_sorted(
      matches.begin(), matches.end(),
      [](const LandmarkMatch& a, const LandmarkMatch& b) { return a.ratio < b.ratio; }));
}

class LookUpOfKind : public testing::TestWithParam<DescriptorKind> {};

TEST_P(LookUpOfKind, FindsTheLandmarksThatAreSeenAndNoOthers) {
  const Street street(GetParam());
  const auto map = street.draft.Open();
  for (const bool exact : {false, true}) {
    LookUpOptions options;
    options.search.exact = exact;
    const auto matches = LookUp(*map, street.features, SceneLens(), {}, options);
    ASSERT_TRUE(matches.ok());
    EXPECT_GT(Right(*matches), 240);
    EXPECT_LE(matches->size(), static_cast<std::size_t>(Right(*matches) + 2));
    ExpectNothingTwiceBestFirst(*matches);
  }
}

TEST_P(LookUpOfKind, GivesTheLandmarkAsTheMapHasIt) {
  const Street street(GetParam());
  const auto map = street.draft.Open();
  for (const LandmarkMatch& match : Find(*map, street.features)) {
    if (match.feature != match.landmark.id) continue;
    const Keypoint& keypoint = street.features.keypoints[match.feature];
    EXPECT_EQ(match.pixel, Eigen::Vector2d(keypoint.x_px, keypoint.y_px));
    EXPECT_LT((match.landmark.position_in_enu_m - street.places[match.feature]).norm(), 1e-6);
    EXPECT_NEAR(match.landmark.covariance_m2(2, 2), 3e-4, 1e-9);
  }
}

TEST_P(LookUpOfKind, GuidedFindsThemToo) {
  const Street street(GetParam());
  const auto map = street.draft.Open();
  const auto matches =
      LookUpGuided(*map, street.features, SceneLens(), LookingNorth({0.05, 0.0, 0.0}), 8.0, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_GT(Right(*matches), 240);
  ExpectNothingTwiceBestFirst(*matches);
}

TEST_P(LookUpOfKind, RefusesFeaturesOfTheOtherKind) {
  const Street street(GetParam());
  const auto map = street.draft.Open();
  const Street other(GetParam() == kSift ? DescriptorKind::kOrb : kSift);
  const auto matches = LookUp(*map, other.features, SceneLens(), {}, {});
  ASSERT_FALSE(matches.ok());
  EXPECT_EQ(matches.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(matches.error().message, testing::HasSubstr("another kind"));
  EXPECT_FALSE(LookUpGuided(*map, other.features, SceneLens(), LookingNorth(), 8.0, {}).ok());
}

INSTANTIATE_TEST_SUITE_P(Sift, LookUpOfKind, testing::Values(kSift));
INSTANTIATE_TEST_SUITE_P(Orb, LookUpOfKind, testing::Values(DescriptorKind::kOrb));

TEST(LookUp, GivesALandmarkOnlyToTheFeatureMostLikeIt) {
  Street street(kSift);
  for (std::uint32_t id = 0; id < 50; ++id) {  // a worse view of the same, first and second
    AddFeature({1.0, 1.0},
               SeenAgain(kSift, SeenAgain(kSift, street.looks[id], street.random), street.random),
               &street.features);
  }
  const std::vector<LandmarkMatch> matches = Find(*street.draft.Open(), street.features);
  EXPECT_GT(matches.size(), 240U);
  ExpectNothingTwiceBestFirst(matches);
}

TEST(LookUp, DoesNotChooseBetweenTwoThatLookAlike) {
  Street street(kSift);
  street.AddTwins([](const Eigen::Vector3d& place) -> Eigen::Vector3d { return -place; },
                  {0, 0, 0});
  EXPECT_LT(Find(*street.draft.Open(), street.features).size(), 10U);
}

TEST(LookUp, LeavesOutWhatIsBehindTheCamera) {
  Street street(kSift);
  street.AddTwins([](const Eigen::Vector3d& place) -> Eigen::Vector3d { return -place; },
                  {0, 0, 0});
  const auto map = street.draft.Open();
  ViewPrior prior = AtOrigin();
  EXPECT_LT(Find(*map, street.features, prior).size(), 10U);  // the heading is what tells
  prior.heading_rad = 0.1;
  prior.heading_sigma_rad = 0.1;
  const std::vector<LandmarkMatch> matches = Find(*map, street.features, prior);
  EXPECT_GT(Right(matches), 240);
  prior.heading_rad = 3.1;
  EXPECT_EQ(Right(Find(*map, street.features, prior)), 0);
}

TEST(LookUp, LeavesOutWhatIsTooFar) {
  Street street(kSift);
  street.AddTwins([](const Eigen::Vector3d& place) -> Eigen::Vector3d { return 3.5 * place; },
                  {0, 0, 0});
  const auto map = street.draft.Open();
  EXPECT_LT(Find(*map, street.features).size(), 10U);
  ViewPrior prior = AtOrigin();
  prior.farthest_m = 48.0;  // twins are at 52 m and more; three sigma are added
  EXPECT_GT(Right(Find(*map, street.features, prior)), 150);
}

TEST(LookUp, LeavesOutWhatIsHidden) {
  Street street(kSift);
  street.AddTwins([](const Eigen::Vector3d& place) -> Eigen::Vector3d { return 3.5 * place; },
                  {0, 0, 0});
  const auto map = street.draft.Open();
  LookUpOptions options;
  options.may_be_seen = [](const Landmark& landmark) {
    return landmark.position_in_enu_m.norm() < 51.0;  // twins are at 52 m and more
  };
  EXPECT_GT(Right(Find(*map, street.features, AtOrigin(), options)), 150);
  options.may_be_seen = [](const Landmark&) { return false; };
  EXPECT_TRUE(Find(*map, street.features, AtOrigin(), options).empty());
}

TEST_P(LookUpOfKind, GuidedLeavesOutWhatIsHiddenToo) {
  const Street street(GetParam());
  const auto map = street.draft.Open();
  LookUpOptions options;
  options.may_be_seen = [](const Landmark& landmark) {
    return landmark.position_in_enu_m.x() > 0.0;
  };
  const auto matches =
      LookUpGuided(*map, street.features, SceneLens(), LookingNorth(), 8.0, options);
  ASSERT_TRUE(matches.ok());
  EXPECT_GT(matches->size(), 60U);
  for (const LandmarkMatch& match : *matches) {
    EXPECT_GT(match.landmark.position_in_enu_m.x(), 0.0);
  }
}

TEST(LookUp, LeavesOutWhatWasSeenFromTheOtherSide) {
  Street street(kSift);
  street.AddTwins(
      [](const Eigen::Vector3d& place) -> Eigen::Vector3d {
        return place + Eigen::Vector3d(1.0, 0.0, 0.0);
      },
      {0.0, 80.0, 0.0});
  const auto map = street.draft.Open();
  EXPECT_LT(Find(*map, street.features).size(), 10U);
  EXPECT_GT(Right(Find(*map, street.features, AtOrigin())), 240);
}

TEST(LookUp, FindsNothingFromNothing) {
  const Street street(kSift);
  const auto map = street.draft.Open();
  EXPECT_TRUE(Find(*map, Features{}).empty());
  EXPECT_TRUE(Find(*MapDraft(kSift).Open(), street.features).empty());
  ViewPrior elsewhere = AtOrigin();
  elsewhere.position_in_enu_m = {5000.0, 0.0, 0.0};
  EXPECT_TRUE(Find(*map, street.features, elsewhere).empty());
}

TEST(LookUp, RefusesFeaturesWithoutDescriptors) {
  Street street(kSift);
  street.features.descriptors.pop_back();
  const auto map = street.draft.Open();
  EXPECT_FALSE(LookUp(*map, street.features, SceneLens(), {}, {}).ok());
  EXPECT_FALSE(LookUpGuided(*map, street.features, SceneLens(), LookingNorth(), 8.0, {}).ok());
}

TEST(LookUp, RefusesPriorsThatMakeNoSense) {
  const Street street(kSift);
  const auto map = street.draft.Open();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ViewPrior> priors(6, AtOrigin());
  priors[0].position_in_enu_m.x() = kNan;
  priors[1].position_covariance_m2(1, 1) = kNan;
  priors[2].position_covariance_m2(1, 1) = -1.0;
  priors[3].farthest_m = 0.0;
  priors[4].heading_rad = kNan;
  priors[5].heading_rad = 0.0;
  priors[5].heading_sigma_rad = -0.1;
  for (const ViewPrior& prior : priors) {
    const auto matches = LookUp(*map, street.features, SceneLens(), prior, {});
    ASSERT_FALSE(matches.ok());
    EXPECT_THAT(matches.error().message, testing::HasSubstr("view prior"));
  }
}

TEST(LookUp, RefusesTablesOutOfProportionToTheMap) {
  Street street(kSift);
  street.draft.Add((1U << 26U) - 1U, {0.0, 20.0, 0.0}, {street.looks[0]});
  const auto matches = LookUp(*street.draft.Open(), street.features, SceneLens(), AtOrigin(), {});
  ASSERT_FALSE(matches.ok());
  EXPECT_EQ(matches.error().code, ErrorCode::kUnsupported);
}

// A facade: 24 windows in four rows that look all the same, 2 m apart at 20 m, 49 px.
struct Facade {
  Facade() {
    features.kind = kSift;
    const Look window = RandomLook(kSift, random);
    for (std::uint32_t id = 0; id < 24; ++id) {
      const Eigen::Vector3d place(2.0 * (id % 6) - 5.0, 20.0, 2.0 * (id / 6) - 3.0);
      draft.Add(id, place, {SeenAgain(kSift, window, random)});
      AddFeature(*SceneLens().Project(LookingNorth() * place), SeenAgain(kSift, window, random),
                 &features);
    }
  }

  Random random{12};
  MapDraft draft{kSift};
  Features features;
};

TEST(LookUpGuided, TellsWindowsApartByWhereTheyMustBe) {
  const Facade facade;
  const auto map = facade.draft.Open();
  EXPECT_LT(Find(*map, facade.features).size(), 5U);
  const auto matches =
      LookUpGuided(*map, facade.features, SceneLens(), LookingNorth({0.2, 0.1, -0.2}), 15.0, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_EQ(matches->size(), 24U);
  EXPECT_EQ(Right(*matches), 24);
}

TEST(LookUpGuided, LooksNoFurtherThanItsRadius) {
  const Facade facade;
  const auto map = facade.draft.Open();
  const auto matches =
      LookUpGuided(*map, facade.features, SceneLens(), LookingNorth({1.0, 0.0, 0.0}), 15.0, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_TRUE(matches->empty());
}

TEST(LookUpGuided, TakesNothingForALandmarkThatLooksDifferent) {
  Facade facade;
  for (std::uint8_t& byte : facade.features.descriptors) {
    byte = static_cast<std::uint8_t>(facade.random.Index(90));
  }
  const auto matches =
      LookUpGuided(*facade.draft.Open(), facade.features, SceneLens(), LookingNorth(), 15.0, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_TRUE(matches->empty());
}

TEST(LookUpGuided, LeavesOutWhatWasSeenFromTheOtherSide) {
  Random random(13);
  MapDraft draft(kSift);
  const Look look = RandomLook(kSift, random);
  draft.Add(0, {0.0, 20.0, 0.0}, {look}, {0.0, 60.0, 0.0});
  Features features;
  AddFeature({319.5, 239.5}, look, &features);
  const auto matches = LookUpGuided(*draft.Open(), features, SceneLens(), LookingNorth(), 15.0, {});
  ASSERT_TRUE(matches.ok());
  EXPECT_TRUE(matches->empty());
}

TEST(LookUpGuided, RefusesPosesAndRadiiThatAreNone) {
  const Facade facade;
  const auto map = facade.draft.Open();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const Rigid3& pose, double radius_px) {
    return !LookUpGuided(*map, facade.features, SceneLens(), pose, radius_px, {}).ok();
  };
  EXPECT_TRUE(refused(LookingNorth(), 0.0));
  EXPECT_TRUE(refused(LookingNorth(), -1.0));
  EXPECT_TRUE(refused(LookingNorth(), kNan));
  EXPECT_TRUE(refused(LookingNorth({kNan, 0.0, 0.0}), 5.0));
  EXPECT_TRUE(refused(Rigid3(Eigen::Quaterniond(0, 0, 0, kNan), Eigen::Vector3d::Zero()), 5.0));
  EXPECT_FALSE(refused(LookingNorth(), 1e12));
}

}  // namespace
}  // namespace lodemark
