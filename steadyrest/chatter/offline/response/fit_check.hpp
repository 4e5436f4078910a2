// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

/// Responses that cannot be fitted, and results that are not a fit.
namespace steadyrest::chatter::offline {

/// A measurement given twice, whatever its copies are called.
[[nodiscard]] std::optional<kernel::outcome::Refusal> given_twice(std::span<const Frf> responses);

/// Responses of different points or directions, as far as universal files name them.
[[nodiscard]] std::optional<kernel::outcome::Refusal> other_point(std::span<const Frf> responses);

/// Modes that leave `residual` (RMS, as a share) of the responses h at ω = `w`, and so explain no
/// more than they would of noise. The bound is an information criterion: without modes,
/// c − d/ω² leaves s₀; fitted noise lowers −2 ln L = 4·N·ln s by 3·ln 2N for each mode and by up to
/// 16 more (100 seeds each of even and of 1/ω² noise at 8, 12, 20 and 50 points; at 200 and 1900
/// points by less than the criterion charges). The bound requires 20:
///   s < s₀·exp(−(3·modes·ln 2N + 20)/4N),  N = (Σ|h₀|²)²/Σ|h₀|⁴ of what c − d/ω² leaves.
/// N is an effective number of points: a few large ones at one end of the band count as few.
[[nodiscard]] std::optional<kernel::outcome::Refusal> no_more_than_noise(const Eigen::ArrayXd& w,
                                                                         const Eigen::ArrayXcd& h,
                                                                         std::size_t modes,
                                                                         double residual);

}  // namespace steadyrest::chatter::offline
