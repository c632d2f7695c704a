// How wide a path is to a wave: the first Fresnel zone.
#pragma once

namespace lodemark {

// Radius of the first Fresnel zone at a distance from the near end of a path, zero at its ends.
// ITU-R P.526-15, section 2, equation (2): the root of wavelength * d1 * d2 / (d1 + d2); for a path
// without end (a satellite) the root of wavelength * d1. Zero for wavelength 0, which means light:
// a straight line.
double FirstFresnelRadius(double wavelength_m, double distance_m, double path_length_m);

}  // namespace lodemark
