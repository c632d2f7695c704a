// Colours as amounts of light, and as the bytes of picture files.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace lodemark {

// Red, green and blue in proportion to light; as a surface's colour, the share it sends back.
struct Colour {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;

  Colour& operator+=(const Colour& other) {
    r += other.r;
    g += other.g;
    b += other.b;
    return *this;
  }
};

inline Colour operator+(const Colour& a, const Colour& b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Colour operator*(const Colour& a, const Colour& b) {
  return {a.r * b.r, a.g * b.g, a.b * b.b};
}
inline Colour operator*(float s, const Colour& c) { return {s * c.r, s * c.g, s * c.b}; }

// share 0: a, share 1: b.
inline Colour Mix(const Colour& a, const Colour& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

inline Colour Grey(float level) { return {level, level, level}; }

// 0 at and below low, 1 at and above high, smooth between.
inline float SmoothStep(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

// The sRGB curve (IEC 61966-2-1): light 0 .. 1 to a byte, clipped, and back.
std::uint8_t ByteFromLight(float light);
const std::array<float, 256>& LightOfBytes();

}  // namespace lodemark
