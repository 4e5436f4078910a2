// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace steadyrest::contour::offline {

/// The law of an axis and of what its encoder sees.
///
///   ρτ²·x‴ + τ·x″ + x′ = k·(c(t − d) − x) + f·c′(t − d)
///   y = x + g·(h − x) − o,   h″ = ω²·(x − h) + 2ζω·(x′ − h′)
///
/// At each reversal of the command the first `lost` of x's motion in the new direction is lost.
struct ServoLaw {
  double gain_1_s = 0.0;      ///< k
  double feed_forward = 0.0;  ///< f
  double lag_s = 0.0;         ///< τ; 0: the velocity loop is ideal
  double second = 0.0;        ///< ρ = 1/(4·damping²) of the velocity loop; 0: first order
  double delay_s = 0.0;       ///< d
  double mode_rad_s = 0.0;    ///< ω
  double mode_damping = 0.0;  ///< ζ
  double mode_weight = 0.0;   ///< g; 0: no mode
  double rest_error = 0.0;    ///< o
  double lost = 0.0;          ///< at a reversal
};

/// What the encoder would show at each sample if the axis were at the first command's position and
/// at rest then; the command is straight between samples, and before the first it is the first.
/// Exact for any τ and d.
[[nodiscard]] Eigen::VectorXd simulated(const ServoLaw& law, std::span<const double> command,
                                        double period_s);

/// The responses to a unit of each state, a column of size 1 each, until they have gone; at most
/// `count` rows.
[[nodiscard]] Eigen::MatrixXd free_responses(const ServoLaw& law, double period_s,
                                             std::size_t count);

/// Steps of the command up to this are rest.
[[nodiscard]] double rest_step(std::span<const double> command);

/// −1, +1 where the command turns round to move down, up; 0 elsewhere. Steps of up to `least` are
/// rest.
[[nodiscard]] std::vector<int> reversals(std::span<const double> command, double least);

}  // namespace steadyrest::contour::offline
