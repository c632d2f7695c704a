#include "tools/lodemark/sky_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "core/base/units.h"
#include "tools/lodemark/command.h"
#include "tools/report/report.h"

namespace lodemark {
namespace {

constexpr double kWidth_px = 760.0;
constexpr double kCentreX_px = 380.0;
constexpr double kCentreY_px = 372.0;
constexpr double kRadius_px = 290.0;  // of the horizon
constexpr double kStripTop_px = 770.0;
constexpr double kStripLeft_px = 64.0;
constexpr double kStripRight_px = 736.0;
constexpr double kRow_px = 17.0;

constexpr std::size_t kMostBins = 240;  // of time
constexpr int kShades = 10;             // of probability, and one more

// Light and dark as the report has them; probabilities from vermilion over amber to blue, told
// apart by the colour-blind.
constexpr const char* kStyle =
    ".back{fill:#f4f5f7}.disc{fill:#ffffff}.grid{stroke:#d8dde3;fill:none}"
    ".always{fill:#aab4bf}.once{fill:#d3d9e0}.now{fill:none;stroke:#566270;stroke-width:1.5}"
    "text{font:12px system-ui,-apple-system,'Segoe UI',Roboto,'DejaVu Sans',sans-serif;"
    "fill:#566270}.strong{fill:#16202c;font-weight:600}.title{font-size:18px}"
    ".halo{paint-order:stroke;stroke:#ffffff;stroke-width:3px;stroke-linejoin:round}"
    "@media(prefers-color-scheme:dark){.back{fill:#10151b}.disc{fill:#19202a}"
    ".grid{stroke:#323c49}.always{fill:#4b5866}.once{fill:#2f3a46}.now{stroke:#a3afbc}"
    "text{fill:#a3afbc}.strong{fill:#e8edf2}.halo{stroke:#19202a}}";

std::string Colour(double probability) {
  constexpr double kStops[3][3] = {{213, 94, 0}, {230, 170, 20}, {20, 120, 190}};
  const double place = 2.0 * std::clamp(probability, 0.0, 1.0);
  const std::size_t lower = place < 1.0 ? 0 : 1;
  const double share = place - static_cast<double>(lower);
  int parts[3];
  for (std::size_t i = 0; i < 3; ++i) {
    parts[i] = static_cast<int>(
        std::lround((1.0 - share) * kStops[lower][i] + share * kStops[lower + 1][i]));
  }
  return Format("#%02x%02x%02x", parts[0], parts[1], parts[2]);
}

int ShadeOf(double probability) { return static_cast<int>(std::lround(probability * kShades)); }
std::string ShadeColour(int shade) { return Colour(static_cast<double>(shade) / kShades); }

// XML has no control characters.
std::string Escaped(std::string text) {
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = '?';
  }
  return EscapeHtml(text);
}

Eigen::Vector2d Place_px(double azimuth_rad, double elevation_rad) {
  const double radius_px = kRadius_px * (1.0 - std::clamp(elevation_rad / (0.5 * kPi), 0.0, 1.0));
  return {kCentreX_px + radius_px * std::sin(azimuth_rad),
          kCentreY_px - radius_px * std::cos(azimuth_rad)};
}

std::string PointText(double azimuth_rad, double elevation_rad) {
  const Eigen::Vector2d place_px = Place_px(azimuth_rad, elevation_rad);
  return Format("%.1f,%.1f", place_px.x(), place_px.y());
}

std::string SkylineText(const Skyline& skyline) {
  std::string text;
  for (std::size_t degree = 0; degree < skyline.size(); ++degree) {
    text += degree == 0 ? "M" : "L";
    text += PointText(kRadiansPerDegree * static_cast<double>(degree), skyline[degree]);
  }
  return text + "Z";
}

// From the horizon up to a skyline.
std::string RoofsText(const char* look, const Skyline& skyline) {
  return std::string("<path class=\"") + look + "\" fill-rule=\"evenodd\" d=\"" +
         SkylineText(Skyline{}) + SkylineText(skyline) + "\"/>\n";
}

// What a satellite was like within one stretch of time.
struct Bin {
  int looks = 0;
  double probability = 0.0;  // sum
  double azimuth_rad = 0.0;  // at the last look
  double elevation_rad = 0.0;

  double mean() const { return probability / looks; }
};

struct Track {
  std::vector<Bin> bins;
  SkySatellite last;
};

struct Tracks {
  std::size_t bins = 1;
  std::int64_t first_gps_ns = 0;
  std::int64_t last_gps_ns = 0;
  std::map<SatelliteId, Track> satellites;

  explicit Tracks(std::span<const SkyMoment> moments) {
    if (moments.empty()) return;
    bins = std::clamp(moments.size(), std::size_t{1}, kMostBins);
    first_gps_ns = moments.front().time_gps_ns;
    last_gps_ns = moments.back().time_gps_ns;
    const double length_ns = static_cast<double>(last_gps_ns - first_gps_ns) + 1.0;
    for (const SkyMoment& moment : moments) {
      const double share = static_cast<double>(moment.time_gps_ns - first_gps_ns) / length_ns;
      const auto place =
          static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(bins));
      for (const SkySatellite& satellite : moment.satellites) {
        Track& track = satellites[satellite.satellite];
        track.bins.resize(bins);
        Bin& bin = track.bins[std::min(place, bins - 1)];
        ++bin.looks;
        bin.probability += satellite.probability;
        bin.azimuth_rad = satellite.azimuth_rad;
        bin.elevation_rad = satellite.elevation_rad;
        track.last = satellite;
      }
    }
  }
};

void DrawGrid(std::string* svg) {
  for (const int elevation_deg : {0, 30, 60}) {
    *svg += Format("<circle class=\"grid\" cx=\"%g\" cy=\"%g\" r=\"%.1f\"/>\n", kCentreX_px,
                   kCentreY_px, kRadius_px * (1.0 - elevation_deg / 90.0));
  }
  constexpr const char* kNames[] = {"N", "30",  "60",  "E", "120", "150",
                                    "S", "210", "240", "W", "300", "330"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    const double azimuth_rad = kRadiansPerDegree * 30.0 * static_cast<double>(i);
    const double x = std::sin(azimuth_rad);
    const double y = -std::cos(azimuth_rad);
    *svg += Format("<path class=\"grid\" d=\"M%g,%gL%.1f,%.1f\"/>\n", kCentreX_px, kCentreY_px,
                   kCentreX_px + kRadius_px * x, kCentreY_px + kRadius_px * y);
    *svg += Format("<text%s text-anchor=\"middle\" x=\"%.1f\" y=\"%.1f\">%s</text>\n",
                   i % 3 == 0 ? " class=\"strong\"" : "", kCentreX_px + (kRadius_px + 16.0) * x,
                   kCentreY_px + (kRadius_px + 16.0) * y + 4.0, kNames[i]);
  }
  for (const int elevation_deg : {30, 60}) {
    *svg += Format("<text class=\"halo\" x=\"%.1f\" y=\"%.1f\">%d°</text>\n", kCentreX_px + 3.0,
                   kCentreY_px - kRadius_px * (1.0 - elevation_deg / 90.0) - 3.0, elevation_deg);
  }
}

// Stretches of one shade after another, each joined to the next.
void DrawPath(const Track& track, std::string* svg) {
  std::string points;
  int shade = -1;
  const auto finish = [&] {
    if (points.find(' ') != std::string::npos) {
      *svg += "<polyline fill=\"none\" stroke-width=\"3\" stroke-linecap=\"round\" stroke=\"" +
              ShadeColour(shade) + "\" points=\"" + points + "\"/>\n";
    }
  };
  std::string before;
  for (const Bin& bin : track.bins) {
    if (bin.looks == 0) {
      finish();
      points.clear();
      before.clear();
      shade = -1;
      continue;
    }
    const std::string point = PointText(bin.azimuth_rad, bin.elevation_rad);
    if (ShadeOf(bin.mean()) != shade) {
      finish();
      points = before;
      shade = ShadeOf(bin.mean());
    }
    if (!points.empty()) points += ' ';
    points += point;
    before = point;
  }
  finish();
}

// Full where it is more likely in sight than not, hollow where not.
void DrawMarker(const std::string& name, const SkySatellite& satellite, std::string* svg) {
  const std::string colour = Colour(satellite.probability);
  const Eigen::Vector2d place_px = Place_px(satellite.azimuth_rad, satellite.elevation_rad);
  *svg +=
      "<g><title>" + name +
      Format(": azimuth %.0f°, elevation %.0f°, skyline %.0f°, in sight with %.0f %%</title>",
             satellite.azimuth_rad * kDegreesPerRadian, satellite.elevation_rad * kDegreesPerRadian,
             satellite.skyline_rad * kDegreesPerRadian, 100.0 * satellite.probability);
  *svg += Format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"7\" stroke=\"%s\" stroke-width=\"3\" ",
                 place_px.x(), place_px.y(), colour.c_str());
  *svg += satellite.probability >= 0.5 ? "fill=\"" + colour + "\"/>" : "class=\"disc\"/>";
  *svg += "</g>\n";
}

// On the side where no neighbour of about the same height is near.
void DrawName(const std::string& name, const SkySatellite& satellite, const Tracks& tracks,
              std::string* svg) {
  constexpr double kNear_px = 40.0;
  const Eigen::Vector2d place_px = Place_px(satellite.azimuth_rad, satellite.elevation_rad);
  bool left = false;
  for (const auto& [other, track] : tracks.satellites) {
    const Eigen::Vector2d beside_px =
        Place_px(track.last.azimuth_rad, track.last.elevation_rad) - place_px;
    left = left || (other != satellite.satellite && beside_px.x() >= 0.0 &&
                    beside_px.x() < kNear_px && std::abs(beside_px.y()) < 12.0);
  }
  *svg += Format("<text class=\"strong halo\"%s x=\"%.1f\" y=\"%.1f\">%s</text>\n",
                 left ? " text-anchor=\"end\"" : "", place_px.x() + (left ? -11.0 : 11.0),
                 place_px.y() + 4.0, name.c_str());
}

void DrawLegend(std::string* svg) {
  constexpr double kTop_px = 706.0;
  *svg += Format("<text x=\"%g\" y=\"%g\">in plain sight with</text>\n", 64.0, kTop_px + 11.0);
  constexpr double kLeft_px = 182.0;
  constexpr double kShade_px = 14.0;
  for (int shade = 0; shade <= kShades; ++shade) {
    *svg += Format("<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"14\" fill=\"%s\"/>\n",
                   kLeft_px + kShade_px * shade, kTop_px, kShade_px, ShadeColour(shade).c_str());
  }
  for (const int percent : {0, 50, 100}) {
    *svg +=
        Format("<text text-anchor=\"middle\" x=\"%g\" y=\"%g\">%d %%</text>\n",
               kLeft_px + kShade_px * (0.5 + 0.01 * percent * kShades), kTop_px + 28.0, percent);
  }
  const struct {
    const char* look;
    const char* words;
    double x_px;
  } entries[] = {{"always", "roofs, always", 390.0},
                 {"once", "at times", 515.0},
                 {"now", "at the end", 610.0}};
  for (const auto& [look, words, x_px] : entries) {
    *svg += Format("<rect class=\"%s\" x=\"%g\" y=\"%g\" width=\"22\" height=\"14\"/>\n", look,
                   x_px, kTop_px);
    *svg += Format("<text x=\"%g\" y=\"%g\">%s</text>\n", x_px + 29.0, kTop_px + 11.0, words);
  }
}

void DrawStrip(const std::string& name, const Track& track, double top_px, std::string* svg) {
  *svg += Format("<text class=\"strong\" text-anchor=\"end\" x=\"%g\" y=\"%g\">%s</text>\n",
                 kStripLeft_px - 8.0, top_px + 11.0, name.c_str());
  const double bin_px = (kStripRight_px - kStripLeft_px) / static_cast<double>(track.bins.size());
  const auto shade_at = [&](std::size_t i) {
    return track.bins[i].looks > 0 ? ShadeOf(track.bins[i].mean()) : -1;
  };
  std::size_t first = 0;
  for (std::size_t i = 1; i <= track.bins.size(); ++i) {
    if (i < track.bins.size() && shade_at(i) == shade_at(first)) continue;
    if (shade_at(first) >= 0) {
      *svg += Format("<rect x=\"%.2f\" y=\"%g\" width=\"%.2f\" height=\"%g\" fill=\"%s\"/>\n",
                     kStripLeft_px + bin_px * static_cast<double>(first), top_px,
                     bin_px * static_cast<double>(i - first), kRow_px - 3.0,
                     ShadeColour(shade_at(first)).c_str());
    }
    first = i;
  }
}

}  // namespace

std::string DrawSky(const std::string& title, const SkyView& view,
                    std::span<const SkyMoment> moments) {
  const Tracks tracks(moments);
  const double height_px =
      kStripTop_px + kRow_px * static_cast<double>(tracks.satellites.size()) + 34.0;
  const std::string name = Escaped(title);
  std::string svg = Format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" "
      "height=\"%g\" role=\"img\">\n",
      kWidth_px, height_px, kWidth_px, height_px);
  svg += "<title>Sky over " + name + "</title>\n<style>" + kStyle + "</style>\n";
  svg += Format("<rect class=\"back\" width=\"%g\" height=\"%g\"/>\n", kWidth_px, height_px);
  svg += "<text class=\"strong title\" x=\"24\" y=\"34\">Sky over " + name + "</text>\n";
  const std::string last = CalendarText(tracks.last_gps_ns);
  svg += "<text x=\"24\" y=\"54\">" + CalendarText(tracks.first_gps_ns) + " to " +
         last.substr(last.size() - 8) + " GPS time</text>\n";

  svg += Format("<circle class=\"disc\" cx=\"%g\" cy=\"%g\" r=\"%g\"/>\n", kCentreX_px, kCentreY_px,
                kRadius_px);
  svg += RoofsText("once", view.highest_skyline());
  svg += RoofsText("always", view.lowest_skyline());
  DrawGrid(&svg);
  svg += "<path class=\"now\" d=\"" + SkylineText(view.last_skyline()) + "\"/>\n";
  for (const auto& [satellite, track] : tracks.satellites) DrawPath(track, &svg);
  for (const auto& [satellite, track] : tracks.satellites) {
    DrawMarker(SatelliteName(satellite), track.last, &svg);
  }
  for (const auto& [satellite, track] : tracks.satellites) {
    DrawName(SatelliteName(satellite), track.last, tracks, &svg);
  }
  DrawLegend(&svg);
  double top_px = kStripTop_px;
  for (const auto& [satellite, track] : tracks.satellites) {
    DrawStrip(SatelliteName(satellite), track, top_px, &svg);
    top_px += kRow_px;
  }
  svg += Format("<text x=\"%g\" y=\"%g\">0 s</text>\n", kStripLeft_px, top_px + 14.0);
  svg +=
      Format("<text text-anchor=\"end\" x=\"%g\" y=\"%g\">%.0f s</text>\n", kStripRight_px,
             top_px + 14.0, 1e-9 * static_cast<double>(tracks.last_gps_ns - tracks.first_gps_ns));
  return svg + "</svg>\n";
}

}  // namespace lodemark
