#include "core/gnss/ionosphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/geo/time.h"

namespace lodemark {
namespace {

constexpr double kL1_hz = 1575.42e6;
const Eigen::Vector3d kUnused = Eigen::Vector3d::Zero();

std::int64_t GpsOfUtc(int year, int month, int day, int hour, int minute) {
  return GpsFromScale(*NanosecondsFromCalendar({year, month, day, hour, minute, 0.0}),
                      TimeScale::kUtc);
}

Geodetic Place(double latitude_deg, double longitude_deg, double height_m) {
  return {latitude_deg * kRadiansPerDegree, longitude_deg * kRadiansPerDegree, height_m};
}

LookAngles Look(const Geodetic& satellite, const Geodetic& receiver) {
  return LookAnglesTo(EcefFromGeodetic(satellite), EcefFromGeodetic(receiver),
                      EnuFromEcefRotation(receiver));
}

// Annex of the NTCM-G Ionospheric Model Description: input and slant content, day 105.
struct NtcmCase {
  int level;
  int hour_utc;
  double longitude_deg, latitude_deg, height_m;
  double satellite_longitude_deg, satellite_latitude_deg, satellite_height_m;
  double content_tecu;
};

constexpr std::array<double, 3> kNtcmLevels[3] = {{236.831641, -0.39362878, 0.00402826613},
                                                  {121.129893, 0.351254133, 0.0134635348},
                                                  {2.580271, 0.127628236, 0.0252748384}};

constexpr NtcmCase kNtcmCases[] = {
    {0, 0, -62.34, 82.49, 78.11, 8.23, 54.29, 20281546.18, 33.7567},
    {0, 4, -62.34, 82.49, 78.11, 140.68, 35.85, 19953735.00, 54.6962},
    {0, 20, -62.34, 82.49, 78.11, -52.46, 24.28, 19831557.96, 87.9216},
    {0, 0, -52.81, 5.25, -25.76, -89.48, -29.05, 20081457.33, 125.2377},
    {0, 12, -52.81, 5.25, -25.76, -120.35, 11.00, 20283503.35, 184.0749},
    {0, 20, -52.81, 5.25, -25.76, 10.94, 44.72, 20450566.19, 252.0204},
    {1, 0, 40.19, -3.00, -23.32, 76.65, -41.43, 20157673.93, 28.3208},
    {1, 8, 40.19, -3.00, -23.32, 89.22, -40.56, 20055109.63, 149.9891},
    {1, 20, 40.19, -3.00, -23.32, -1.81, -52.00, 20332764.38, 69.9599},
    {1, 0, 115.89, -31.80, 12.78, 165.14, -13.93, 20181976.57, 38.5473},
    {1, 12, 115.89, -31.80, 12.78, 133.47, -24.87, 19975574.41, 21.5454},
    {1, 20, 115.89, -31.80, 12.78, 115.68, -52.78, 20231909.06, 7.8470},
    {2, 0, 141.13, 39.14, 117.00, 165.14, -13.93, 20181976.50, 51.5270},
    {2, 12, 141.13, 39.14, 117.00, 115.63, -1.28, 20165065.92, 22.6981},
    {2, 20, 141.13, 39.14, 117.00, -136.92, 46.53, 20309713.36, 15.2671},
    {2, 0, -155.46, 19.80, 3754.69, 179.32, 9.92, 20274303.54, 41.9874},
    {2, 12, -155.46, 19.80, 3754.69, -146.53, 22.03, 20069033.97, 9.7271},
    {2, 20, -155.46, 19.80, 3754.69, -82.52, 20.64, 19937791.48, 67.4750},
};

TEST(NtcmG, GivesTheSlantContentOfItsDocument) {
  for (const NtcmCase& c : kNtcmCases) {
    const Geodetic receiver = Place(c.latitude_deg, c.longitude_deg, c.height_m);
    const Geodetic satellite =
        Place(c.satellite_latitude_deg, c.satellite_longitude_deg, c.satellite_height_m);
    // Day 105 of a common year is 15 April.
    const std::int64_t time_gps_ns = GpsOfUtc(2019, 4, 15, c.hour_utc, 0);
    const double delay_m = NtcmGDelay({kNtcmLevels[c.level], 0}, SeasonOfNtcmG(time_gps_ns),
                                      receiver, Look(satellite, receiver), time_gps_ns, kL1_hz);
    const double content_tecu = delay_m * kL1_hz * kL1_hz / 40.3e16;
    EXPECT_NEAR(content_tecu, c.content_tecu, 2e-4) << c.level << " at " << c.hour_utc;
  }
}

// The program that the model's authors publish (Academy of Opto-Electronics, 2021), with its
// single-layer mapping function, which is that of the document. It reckons in geocentric latitude,
// so the test gives the model the geocentric latitude too.
struct BdgimCase {
  int year, month, day, hour, minute;
  double latitude_deg, longitude_deg, satellite_latitude_deg, satellite_longitude_deg;
  bool active_sun;
  double delay_m;
};

constexpr BdgimParameters kQuiet = {{13.82642069, -1.78004616, 5.172, 3.13030940, -4.58961329,
                                     0.32483867, -0.07802383, 1.24312590, 0.37763627}};
constexpr BdgimParameters kActive = {{40.0, -3.0, 12.0, 5.0, -9.0, 1.5, -1.0, 2.0, 0.7}};

constexpr BdgimCase kBdgimCases[] = {
    {2020, 11, 5, 17, 0, 40, 116, 40, 116, false, 0.9315},
    {2020, 11, 5, 6, 30, 40, 116, 40, 116, false, 2.7352},
    {2021, 3, 21, 4, 10, -33, 151, -33, 151, true, 7.7771},
    {2021, 6, 21, 14, 0, 5, -60, 5, -60, true, 10.5431},
    {2023, 1, 8, 10, 30, 30, 95, 30, 95, true, 8.8632},
    {2024, 9, 9, 23, 59, 70, 20, 70, 20, true, 2.6439},
    {2020, 11, 5, 17, 0, 40, 116, 0, 116, false, 1.4235},
    {2023, 1, 8, 10, 30, 30, 95, 10, 120, true, 11.2756},
};

TEST(Bdgim, AgreesWithItsAuthorsProgram) {
  for (const BdgimCase& c : kBdgimCases) {
    const Eigen::Vector3d receiver_in_ecef =
        EcefFromGeodetic(Place(c.latitude_deg, c.longitude_deg, 0.0));
    const Geodetic receiver = {std::asin(receiver_in_ecef.normalized().z()),
                               c.longitude_deg * kRadiansPerDegree, 0.0};
    const LookAngles look = LookAnglesTo(
        EcefFromGeodetic(Place(c.satellite_latitude_deg, c.satellite_longitude_deg, 2e7)),
        receiver_in_ecef, EnuFromEcefRotation(receiver));
    // The program's days are of BeiDou time.
    const std::int64_t time_gps_ns =
        GpsFromScale(*NanosecondsFromCalendar({c.year, c.month, c.day, c.hour, c.minute, 0.0}),
                     TimeScale::kBeidou);
    const double delay_m = BdgimDelay(c.active_sun ? kActive : kQuiet, PredictBdgim(time_gps_ns),
                                      receiver, look, time_gps_ns, kL1_hz);
    EXPECT_NEAR(delay_m, c.delay_m, 0.005) << c.year << " " << c.latitude_deg;
  }
}

constexpr KlobucharParameters kKlobuchar = {
    System::kGps, {3.82e-8, 1.49e-8, -1.79e-7, 0.0}, {1.43e5, 0.0, -3.28e5, 1.13e5}};

// A worked example published with Mahooti's implementation: 40 N 100 W, elevation 20, azimuth 210,
// second 593,100 of the week.
TEST(Klobuchar, GivesTheWorkedExample) {
  const double delay_m = KlobucharDelay(kKlobuchar, Place(40.0, -100.0, 0.0),
                                        {210.0 * kRadiansPerDegree, 20.0 * kRadiansPerDegree},
                                        2'000 * kWeek_ns + 593'100 * kSecond_ns, kL1_hz);
  EXPECT_NEAR(delay_m, 23.784, 0.001);
}

TEST(Klobuchar, IsTheNightDelayAtNight) {
  const double delay_m = KlobucharDelay(kKlobuchar, Place(40.0, 0.0, 0.0), {0.0, kPi / 2.0},
                                        2'000 * kWeek_ns + 3 * 3600 * kSecond_ns, kL1_hz);
  EXPECT_NEAR(delay_m, kSpeedOfLight_mps * 5e-9, 0.001);
}

TEST(Klobuchar, FollowsTheInverseSquareOfTheFrequency) {
  for (const System system : {System::kGps, System::kBeidou}) {
    KlobucharParameters parameters = kKlobuchar;
    parameters.system = system;
    const auto delay_m = [&](double frequency_hz) {
      return KlobucharDelay(parameters, Place(40.0, -100.0, 0.0), {3.0, 0.4}, 2'000 * kWeek_ns,
                            frequency_hz);
    };
    EXPECT_NEAR(delay_m(1176.45e6) / delay_m(kL1_hz), std::pow(154.0 / 115.0, 2), 1e-9);
  }
}

// Every model, everywhere, at all times of day and below the horizon.
TEST(IonosphereModel, StaysFiniteAndPlausibleEverywhere) {
  IonosphereModel model;
  model.Add({{}, 0, kKlobuchar});
  model.Add({{}, 0, kActive});
  model.Add({{}, 0, GalileoIonosphereParameters{kNtcmLevels[0], 0}});
  using Kind = IonosphereModel::Kind;
  for (const Kind kind : {Kind::kKlobuchar, Kind::kBdgim, Kind::kNtcmG, Kind::kClimatology}) {
    for (int latitude_deg = -90; latitude_deg <= 90; latitude_deg += 30) {
      for (int elevation_deg = -10; elevation_deg <= 90; elevation_deg += 20) {
        for (int hour = 0; hour < 24; hour += 3) {
          double sigma_m = 0.0;
          const double delay_m =
              model.Delay(Place(latitude_deg, 7.0 * hour, 100.0), kUnused, kUnused,
                          {0.3 * hour, elevation_deg * kRadiansPerDegree},
                          2'200 * kWeek_ns + hour * 3600 * kSecond_ns, kL1_hz, &sigma_m, kind);
          EXPECT_GE(delay_m, 0.0);
          EXPECT_LT(delay_m, 150.0);
          EXPECT_GT(sigma_m, 0.1);
          EXPECT_LT(sigma_m, 100.0);
        }
      }
    }
  }
}

TEST(IonosphereModel, TakesTheBestOfWhatItHas) {
  IonosphereModel model;
  using Kind = IonosphereModel::Kind;
  EXPECT_EQ(model.Best(), Kind::kClimatology);
  model.Add({{}, 0, KlobucharParameters{}});  // all zero: nothing was uploaded yet
  EXPECT_EQ(model.Best(), Kind::kClimatology);
  model.Add({{}, 0, kKlobuchar});
  EXPECT_EQ(model.Best(), Kind::kKlobuchar);
  model.Add({{}, 0, GalileoIonosphereParameters{{NAN, 0.0, 0.0}, 0}});
  EXPECT_EQ(model.Best(), Kind::kKlobuchar);
  model.Add({{}, 0, GalileoIonosphereParameters{kNtcmLevels[1], 0}});
  EXPECT_EQ(model.Best(), Kind::kNtcmG);
  model.Add({{}, 0, kQuiet});
  EXPECT_EQ(model.Best(), Kind::kBdgim);
}

TEST(IonosphereModel, FallsBackToClimatologyAndCanBeSilenced) {
  IonosphereModel model;
  const Geodetic place = Place(40.0, -100.0, 0.0);
  using Kind = IonosphereModel::Kind;
  const auto delay_m = [&](std::optional<Kind> kind) {
    return model.Delay(place, kUnused, kUnused, {3.0, 0.4}, 2'000 * kWeek_ns, kL1_hz, nullptr,
                       kind);
  };
  EXPECT_EQ(delay_m(Kind::kBdgim), delay_m(Kind::kClimatology));
  EXPECT_GT(delay_m(std::nullopt), 1.0);
  EXPECT_EQ(delay_m(Kind::kNone), 0.0);
}

TEST(IonosphereModel, KeepsWhatItComputedOnlyAsLongAsItHolds) {
  using Kind = IonosphereModel::Kind;
  IonosphereModel kept;
  kept.Add({{}, 0, kActive});
  // The last second of a day of UTC and the first of the next, among others.
  for (const int second : {3600, 7200, 86'417, 86'418, 90'000, 3600}) {
    const std::int64_t time_gps_ns = 2'200 * kWeek_ns + second * kSecond_ns;
    IonosphereModel fresh;
    fresh.Add({{}, 0, kActive});
    for (const Kind kind : {Kind::kBdgim, Kind::kClimatology}) {
      const auto delay_m = [&](const IonosphereModel& model) {
        return model.Delay(Place(30.0, 95.0, 0.0), kUnused, kUnused, {3.0, 0.4}, time_gps_ns,
                           kL1_hz, nullptr, kind);
      };
      EXPECT_EQ(delay_m(kept), delay_m(fresh)) << second;
    }
  }
}

}  // namespace
}  // namespace lodemark
