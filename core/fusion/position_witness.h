// Something that knows of the position besides satellites, and whose parts can each be mistaken.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/fusion/position_statement.h"

namespace lodemark {

// How well a group of observations fits an adjustment: the sum of their squared residuals in
// sigmas, and what it would be if the sigmas were right.
struct GroupMisfit {
  double squares = 0.0;
  double redundancy = 0.0;
};

// What the landmarks of a photograph say, in the adjustment together with satellites. Its own
// unknowns, such as the camera's attitude, it keeps to itself: a statement is what is left once
// they are eliminated.
class PositionWitness {
 public:
  virtual ~PositionWitness() = default;

  // Puts its own unknowns where they fit the point best and linearises there: called again and
  // again with points ever nearer the answer.
  virtual PositionStatement At(const Eigen::Vector3d& point_in_ecef) = 0;

  // Whether most of what it knows fits the point of the last At together.
  virtual bool Agrees() const = 0;

  // False for one that no other test has found sound: it helps satellites that have a place of
  // their own, and gives none by itself.
  virtual bool is_proven() const { return true; }

  // Parts that can be mistaken by themselves, and whether part i counts now, 0..1.
  virtual std::size_t parts() const = 0;
  virtual double WeightOf(std::size_t part) const = 0;
  // The statement of the last At without one part.
  virtual PositionStatement Without(std::size_t part) const = 0;
  // The same without two different ones.
  virtual PositionStatement WithoutBoth(std::size_t part, std::size_t other) const = 0;
  // That a part is mistaken, before anything is known of how it fits.
  virtual double wrong_probability() const = 0;

  // Of its observations at the last At, where all else has so much information on the position.
  // Nothing for a witness that cannot check itself.
  virtual GroupMisfit MisfitBeside(const Eigen::Matrix3d& /*information_pm2*/) const { return {}; }
  // Takes the sigmas of its observations for so many times as stated. Nothing likewise.
  virtual void ScaleSigmas(double /*factor*/) {}
};

}  // namespace lodemark
