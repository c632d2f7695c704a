#include "core/fusion/inertial_increment.h"

#include "core/geo/rotation.h"

namespace lodemark {
namespace {

using Block = Eigen::Matrix3d;

// Errors of an increment, in the axes of its beginning: noise of the turn is a multiple of the
// identity there, which leaves few products.
struct Errors {
  double turn_turn = 0.0;
  Block velocity_turn = Block::Zero();
  Block moved_turn = Block::Zero();
  Block velocity_velocity = Block::Zero();
  Block moved_velocity = Block::Zero();
  Block moved_moved = Block::Zero();

  // cross: CrossOf the change of velocity within so many seconds.
  void Advance(double seconds, const Block& cross, const InertialNoise& noise) {
    const Block half_cross = 0.5 * seconds * cross;
    const Block old_velocity_turn = velocity_turn;
    // moved += seconds * velocity - half_cross * turn; velocity -= cross * turn.
    const Block moved_velocity_before =
        moved_velocity + seconds * velocity_velocity - half_cross * old_velocity_turn.transpose();
    const Block moved_turn_after =
        moved_turn + seconds * old_velocity_turn - turn_turn * half_cross;
    const Block moved_moved_after =
        moved_moved + seconds * moved_velocity.transpose() - half_cross * moved_turn.transpose() +
        seconds * moved_velocity_before - moved_turn_after * half_cross.transpose();
    moved_velocity = moved_velocity_before - moved_turn_after * cross.transpose();
    const Block velocity_turn_after = old_velocity_turn - turn_turn * cross;
    velocity_velocity +=
        -cross * old_velocity_turn.transpose() - velocity_turn_after * cross.transpose();
    moved_moved = moved_moved_after;
    moved_turn = moved_turn_after;
    velocity_turn = velocity_turn_after;
    const double turn = noise.turn_rate_radps_sqrt_s * noise.turn_rate_radps_sqrt_s * seconds;
    const double force =
        noise.specific_force_mps2_sqrt_s * noise.specific_force_mps2_sqrt_s * seconds;
    turn_turn += turn;
    velocity_velocity.diagonal().array() += force;
    moved_velocity.diagonal().array() += 0.5 * seconds * force;
    moved_moved.diagonal().array() += seconds * seconds * force / 3.0;
  }
};

}  // namespace

InertialIncrement IntegrateInertial(std::span<const InertialSample> samples,
                                    const InertialBiases& biases, const InertialNoise& noise) {
  InertialIncrement sum;
  Errors errors;
  Block turn_by_turn_rate = Block::Zero();
  Block velocity_by_turn_rate = Block::Zero();
  Block moved_by_turn_rate = Block::Zero();
  Block velocity_by_force = Block::Zero();
  Block moved_by_force = Block::Zero();
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const InertialSample& from = samples[i];
    const InertialSample& to = samples[i + 1];
    const double seconds = 1e-9 * static_cast<double>(to.time_ns - from.time_ns);
    if (!(seconds > 0.0)) continue;
    const Eigen::Vector3d rate =
        0.5 * (from.turn_rate_radps + to.turn_rate_radps) - biases.turn_rate_radps;
    const Eigen::Vector3d force =
        0.5 * (from.specific_force_mps2 + to.specific_force_mps2) - biases.specific_force_mps2;
    // The force acts in the axes of half the time.
    const Eigen::Quaterniond half = Turn(0.5 * seconds * rate);
    const Eigen::Quaterniond middle = sum.turn * half;
    const Block axes = middle.toRotationMatrix();
    const Eigen::Vector3d gained = seconds * (axes * force);
    const Block cross = CrossOf(gained);

    const Block turn_half = turn_by_turn_rate - 0.5 * seconds * axes;
    const Block velocity_gain = -cross * turn_half;
    moved_by_turn_rate += seconds * velocity_by_turn_rate + 0.5 * seconds * velocity_gain;
    velocity_by_turn_rate += velocity_gain;
    turn_by_turn_rate -= seconds * axes;
    moved_by_force += seconds * velocity_by_force - 0.5 * seconds * seconds * axes;
    velocity_by_force -= seconds * axes;
    errors.Advance(seconds, cross, noise);

    sum.moved_m += seconds * sum.velocity_mps + 0.5 * seconds * gained;
    sum.velocity_mps += gained;
    sum.turn = (middle * half).normalized();
    sum.seconds += seconds;
  }
  sum.by_biases << turn_by_turn_rate, Block::Zero(), velocity_by_turn_rate, velocity_by_force,
      moved_by_turn_rate, moved_by_force;
  sum.covariance << errors.turn_turn * Block::Identity(), errors.velocity_turn.transpose(),
      errors.moved_turn.transpose(), errors.velocity_turn, errors.velocity_velocity,
      errors.moved_velocity.transpose(), errors.moved_turn, errors.moved_velocity,
      errors.moved_moved;
  return sum;
}

}  // namespace lodemark
