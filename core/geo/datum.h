// Reference frames that coordinates can be in, and how far apart they are.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>

namespace lodemark {

// Frames of the International Terrestrial Reference System move with the whole earth: a point on a
// plate has a velocity in them of some centimetres a year, and its coordinates belong to an epoch.
// WGS 84 and BDCS agree with them within two centimetres. The others are fixed to a plate.
enum class Datum : std::uint8_t {
  kUnknown,
  kItrf2020,
  kItrf2014,
  kItrf2008,
  kItrf2005,
  kItrf2000,
  kItrf97,
  kWgs84,     // the realisations of this century; GPS, and QZSS within centimetres
  kBdcs,      // of BeiDou
  kCgcs2000,  // ITRF97 at epoch 2000.0, fixed to Eurasia since
  kEtrf2000,  // ETRS89, fixed to Eurasia
};

// By the names in use, whatever their case, spaces and realisation: "WGS84 (G2139)", "itrf 2014",
// "CGCS2000", "ETRS89".
Datum DatumFromName(std::string_view name);
std::string_view NameOf(Datum datum);

// How a point's coordinates change from one frame to another.
struct DatumShift {
  Eigen::Vector3d in_ecef_m = Eigen::Vector3d::Zero();  // to be added
  double sigma_m = 0.0;  // an axis: what of its own plate's motion is not known, and realisations
};

// Of a point fixed to the ground whose coordinates are of one frame and epoch (decimal year), into
// another frame at another epoch. Frames by the IERS parameters (ITRF2014 to earlier ones, Altamimi
// et al. 2016; ITRF2020, Altamimi et al. 2023; ETRF2000, EUREF Technical Note 1), the motion of
// Eurasia by Altamimi et al. 2017. Which plate a point of ITRS frames lies on is not known: its
// motion goes into the sigma. An unknown frame is taken for the other one, within a metre.
DatumShift ShiftBetween(const Eigen::Vector3d& point_in_ecef, Datum from, double from_year,
                        Datum to, double to_year);

}  // namespace lodemark
