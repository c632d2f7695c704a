#include "tools/mapping/footprints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/mapping/building_map.h"

namespace lodemark {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string Feature(const std::string& properties,
                    const std::string& coordinates = "[[[8,48],[8.001,48],[8.001,48.001],[8,48]]]",
                    const std::string& type = "Polygon") {
  return R"({"type":"Feature","properties":)" + properties + R"(,"geometry":{"type":")" + type +
         R"(","coordinates":)" + coordinates + "}}";
}

std::string Collection(const std::string& features) {
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

Footprints Parsed(const std::string& text) {
  Result<Footprints> read = ParseFootprints("town.geojson", text, HeightRules());
  EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message);
  return read.ok() ? *std::move(read) : Footprints();
}

std::string WhyNot(const std::string& text) {
  const Result<Footprints> read = ParseFootprints("town.geojson", text, HeightRules());
  if (read.ok()) return "fine";
  EXPECT_EQ(read.error().code, ErrorCode::kBadData);
  return read.error().message;
}

Footprint One(const std::string& properties) {
  const Footprints read = Parsed(Collection(Feature(properties)));
  EXPECT_EQ(read.buildings.size(), 1U);
  return read.buildings.empty() ? Footprint() : read.buildings.front();
}

TEST(Footprints, ReadsLengthsAsPeopleWriteThem) {
  EXPECT_EQ(ParseLength_m("12"), 12.0);
  EXPECT_EQ(ParseLength_m(" 12.5 m "), 12.5);
  EXPECT_EQ(ParseLength_m("7.5m"), 7.5);
  EXPECT_NEAR(ParseLength_m("40 ft").value_or(0.0), 12.192, 1e-12);
  EXPECT_NEAR(ParseLength_m("40'").value_or(0.0), 12.192, 1e-12);
  EXPECT_NEAR(ParseLength_m("40'6\"").value_or(0.0), 12.3444, 1e-12);
  for (const char* text :
       {"", "tall", "12,5", "~10", "10-12", "12 yd", "nan", "inf", "1e999", "'", "5'6", "--3"}) {
    EXPECT_FALSE(ParseLength_m(text).has_value()) << text;
  }
}

TEST(Footprints, TakesHeightsFromTheTags) {
  Footprint read = One(R"({"building":"yes","height":"12.5 m","building:levels":"9"})");
  EXPECT_EQ(read.top_m, 12.5);
  EXPECT_EQ(read.top_sigma_m, 1.0);
  EXPECT_EQ(read.base_m, 0.0);
  read = One(R"({"building":"yes","building:levels":"4"})");
  EXPECT_EQ(read.top_m, 12.0);
  EXPECT_NEAR(read.top_sigma_m, std::hypot(2.0, 1.2), 1e-12);
  read = One(R"({"tags":{"building":"yes","height":30,"min_height":20.5}})");
  EXPECT_EQ(read.top_m, 30.0);
  EXPECT_EQ(read.base_m, 20.5);
  read = One(R"({"building":"yes","building:levels":5,"building:min_level":"2"})");
  EXPECT_EQ(read.base_m, 6.0);
  EXPECT_EQ(read.top_m, 15.0);
}

TEST(Footprints, GivesTheDefaultWithItsSigmaWhereNothingIsKnown) {
  for (const char* tags : {R"({"building":"yes"})", "{}", "null", R"({"height":-1})",
                           R"({"height":null,"building:levels":"0"})"}) {
    const Footprints read = Parsed(Collection(Feature(tags)));
    ASSERT_EQ(read.buildings.size(), 1U) << tags;
    EXPECT_EQ(read.buildings[0].top_m, 10.0);
    EXPECT_EQ(read.buildings[0].top_sigma_m, 5.0);
    EXPECT_EQ(read.without_height, 1U);
    EXPECT_THAT(read.notes, IsEmpty());
  }
  const Footprints odd = Parsed(Collection(Feature(R"({"name":"Mill","height":"high"})")));
  ASSERT_EQ(odd.notes.size(), 1U);
  EXPECT_EQ(odd.notes[0], "town.geojson: feature 1 (Mill): a height that is no number was ignored");
}

TEST(Footprints, NamesBuildingsAsTheFileDoes) {
  EXPECT_EQ(One(R"({"name":"Rathaus","@id":"way/7"})").building, "Rathaus");
  EXPECT_EQ(One(R"({"@id":"way/7"})").building, "way/7");
  EXPECT_EQ(One("{}").building, "feature 1");
  EXPECT_EQ(One("{\"name\":\"a\\u001b[2J\\u009bb\"}").building, "a[2Jb");
  EXPECT_LE(One(R"({"name":")" + std::string(5'000, 'x') + R"("})").building.size(), 200U);
}

TEST(Footprints, PassesOverWhatIsNoBuilding) {
  const Footprints read =
      Parsed(Collection(Feature(R"({"building":"yes"})") + "," +
                        Feature(R"({"landuse":"forest"})") + "," + Feature(R"({"building":"no"})") +
                        "," + Feature(R"({"building":"yes","location":"underground"})") + "," +
                        Feature(R"({"building":"yes"})", "[8,48]", "Point") + "," +
                        R"({"type":"Feature","properties":{"building":"yes"},"geometry":null})"));
  EXPECT_EQ(read.buildings.size(), 1U);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_THAT(read.notes[0], HasSubstr("5 features passed over"));
  // In a file of nothing but footprints they need no tag.
  EXPECT_EQ(Parsed(Collection(Feature("{}") + "," + Feature("{}"))).buildings.size(), 2U);
}

TEST(Footprints, ReadsMultiPolygonsAndHoles) {
  const Footprints read =
      Parsed(Collection(Feature("{}",
                                "[[[[8,48],[8.01,48],[8.01,48.01],[8,48.01],[8,48]],"
                                "[[8.002,48.002],[8.002,48.004],[8.004,48.004],[8.002,48.002]]],"
                                "[[[8.02,48,90],[8.03,48,90],[8.03,48.01,90],[8.02,48,90]]]]",
                                "MultiPolygon")));
  ASSERT_EQ(read.buildings.size(), 1U);
  ASSERT_EQ(read.buildings[0].outlines_deg.size(), 2U);
  EXPECT_EQ(read.buildings[0].outlines_deg[0].outer.size(), 4U);
  EXPECT_EQ(read.buildings[0].outlines_deg[0].holes.size(), 1U);
  EXPECT_EQ(read.buildings[0].outlines_deg[1].outer[1].x(), 8.03);
}

TEST(Footprints, SaysInOneSentenceWhatIsWrong) {
  EXPECT_EQ(WhyNot("{\n\"type\": oops"), "town.geojson: is no GeoJSON: not JSON in line 2");
  EXPECT_THAT(WhyNot(""), HasSubstr("not JSON in line 1"));
  EXPECT_THAT(WhyNot("[1e999]"), HasSubstr("a number that is too large"));
  EXPECT_THAT(WhyNot("7"), HasSubstr("is no GeoJSON FeatureCollection"));
  EXPECT_THAT(WhyNot(R"({"type":"Topology"})"), HasSubstr("is no GeoJSON FeatureCollection"));
  EXPECT_THAT(WhyNot(R"({"type":"FeatureCollection"})"), HasSubstr("has no list of features"));
  EXPECT_THAT(WhyNot(Collection("")), HasSubstr("holds no footprint"));
  EXPECT_THAT(WhyNot(R"({"crs":{"name":"EPSG:25832"},"type":"FeatureCollection","features":[]})"),
              HasSubstr("convert it first"));
  const std::string good = Feature("{}") + ",";
  const auto second = [&](const std::string& feature) {
    return WhyNot(Collection(good + feature));
  };
  EXPECT_EQ(second("5"), "town.geojson: feature 2: is no GeoJSON Feature");
  EXPECT_THAT(second(R"({"type":"Feature"})"), HasSubstr("feature 2: has no geometry"));
  EXPECT_THAT(second(R"({"type":"Feature","geometry":[]})"), HasSubstr("geometry is no object"));
  EXPECT_THAT(second(Feature("{}", "7")), HasSubstr("has no coordinates"));
  EXPECT_THAT(second(Feature("{}", "[]")), HasSubstr("a polygon is no list of rings"));
  EXPECT_THAT(second(Feature("{}", "[7]")), HasSubstr("a ring is no list of positions"));
  EXPECT_THAT(second(Feature("{}", R"([[["8",48]]])")), HasSubstr("is not [longitude, latitude]"));
  EXPECT_THAT(second(Feature("{}", "[[[8,48],[9,48],[8,48]]]")), HasSubstr("fewer than four"));
  EXPECT_THAT(second(Feature("{}", "[[[8,48],[8,49],[9,49],[9,48]]]")), HasSubstr("not closed"));
  EXPECT_THAT(second(Feature("{}", "[[[8,148],[8,149],[9,149],[8,148]]]")),
              HasSubstr("not on the earth"));
  EXPECT_THAT(second(Feature("{}", "[[[8,48],[8,49],[9,49],[8,48]]]")), HasSubstr("larger than"));
  EXPECT_THAT(second(Feature(R"({"name":"Babel","height":4000})")),
              HasSubstr("feature 2 (Babel): is taller than 1,000 m"));
  EXPECT_THAT(second(Feature(R"({"height":5,"min_height":6})")), HasSubstr("not above its min"));
  EXPECT_THAT(second(Feature(R"({"height":5,"min_height":-6})")), HasSubstr("below the ground"));
}

TEST(Footprints, DoesNotDrownInBrackets) {
  const std::string deep(2'000'000, '[');
  EXPECT_THAT(WhyNot(deep), HasSubstr("not JSON"));
  EXPECT_THAT(WhyNot(deep + std::string(2'000'000, ']')), HasSubstr("is no GeoJSON"));
}

}  // namespace
}  // namespace lodemark
