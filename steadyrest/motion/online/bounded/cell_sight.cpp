// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/motion/online/bounded/cell_sight.hpp>

namespace steadyrest::motion::online {
namespace {

constexpr double kFarOff = 5.0;        ///< standard deviations at which a border no longer matters
constexpr double kNarrow = 0.1;        ///< width of a cell in standard deviations
constexpr double kLeastShare = 1e-10;  ///< below this the model has lost the cell entirely

/// The share of N(mean, s²) in [low, high] and the measurement that would give it the moments of
/// the part inside; r < 0 when nothing can be learnt.
struct Cut {
  double share = 1.0;
  double z = 0.0;
  double r = -1.0;
};

/// For a cell narrow against s, `middle` and `width` in units of s: the density within is nearly
/// even, and differences of tails would cancel.
/// ∫φ over a width w about m is φ(m)·w·(1 + (m² − 1)·w²/24) to third order. The part inside is
/// even, with variance w²/12 in units of s².
Cut narrow_cut(double mean, double s, double middle, double width) noexcept {
  const double even = width * width / 12.0;
  const double most = 1.0 - even;
  return {upper_tail(middle).density * width * (1.0 + 0.5 * (middle * middle - 1.0) * even),
          mean + s * middle, s * s * even / most};
}

/// The cell's borders in each model's standard deviations from its mean.
struct Borders {
  Lanes alpha{};
  Lanes beta{};
  Lanes nearest{};  ///< how far inside the mean lies
  Lanes deviation{};
};

Borders borders_of(const ModelBank& bank, const Lanes& variance, double low, double high) noexcept {
  Borders out;
  for (std::size_t j = 0; j < kModels; ++j) {
    out.deviation[j] = std::sqrt(variance[j]);
    const double inverse = 1.0 / out.deviation[j];
    out.alpha[j] = (low - bank.x[j]) * inverse;
    out.beta[j] = (high - bank.x[j]) * inverse;
    out.nearest[j] = std::min(-out.alpha[j], out.beta[j]);
  }
  return out;
}

/// The cuts of all models from the difference of both tails.
struct Cuts {
  Lanes share{};
  Lanes z{};
  Lanes r{};
  Lanes lost{};  ///< share of the variance cut away
};

// Moments of a normal distribution cut to [α, β], Z its share inside: mean = (φ(α) − φ(β))/Z,
// variance = 1 − lost, lost = mean² − (α·φ(α) − β·φ(β))/Z. The measurement (z, r) that would bring
// a Kalman filter to the same moments has gain = lost: z = m + s·mean/lost, r = s²·(1 −
// lost)/lost. So the cell enters through the ordinary update, and the UD form stays positive.
Cuts cuts_at(const Borders& at, const Lanes& mean, const Lanes& variance) noexcept {
  constexpr double kFarthest = 30.0;  // beyond it density and tail vanish
  Lanes share_a{};
  Lanes share_b{};
  Lanes density_a{};
  Lanes density_b{};
  for (std::size_t j = 0; j < kModels; ++j) {
    const Tail beyond_alpha = upper_tail(std::min(kFarthest, std::abs(at.alpha[j])));
    const Tail beyond_beta = upper_tail(std::min(kFarthest, std::abs(at.beta[j])));
    share_a[j] = beyond_alpha.share;
    density_a[j] = beyond_alpha.density;
    share_b[j] = beyond_beta.share;
    density_b[j] = beyond_beta.density;
  }
  Cuts out;
  for (std::size_t j = 0; j < kModels; ++j) {
    // Outside, both tails are measured from the nearer side: nothing cancels.
    const double within = 1.0 - share_a[j] - share_b[j];
    const double outside = std::abs(share_a[j] - share_b[j]);
    out.share[j] = std::min(-at.alpha[j], at.beta[j]) >= 0.0 ? within : outside;
    const double inverse = 1.0 / std::max(out.share[j], kLeastShare);
    const double shift = (density_a[j] - density_b[j]) * inverse;
    out.lost[j] =
        shift * shift - (at.alpha[j] * density_a[j] - at.beta[j] * density_b[j]) * inverse;
    // Bounded at both ends: lost → 0 is no information, lost → 1 would be an exact measurement.
    const double gain = 1.0 / std::min(1.0 - 1e-6, std::max(out.lost[j], 1e-9));
    out.z[j] = mean[j] + at.deviation[j] * shift * gain;
    out.r[j] = variance[j] * std::max(1e-6, 1.0 - out.lost[j]) * gain;
  }
  return out;
}

}  // namespace

CellSight see_cell(const ModelBank& bank, double low, double high) noexcept {
  CellSight out;
  out.variance = bank.position_variance();
  const Borders at = borders_of(bank, out.variance, low, high);
  const Lanes& near = at.nearest;
  // The common case when the axis moves: every model lies far inside its cell, and no tail is
  // computed.
  if (std::min(std::min(near[0], near[1]), std::min(near[2], near[3])) > kFarOff) {
    return out;
  }
  const Cuts cuts = cuts_at(at, bank.x, out.variance);
  for (std::size_t j = 0; j < kModels; ++j) {
    Cut c{cuts.share[j], cuts.z[j], cuts.r[j]};
    const double width = at.beta[j] - at.alpha[j];
    const double middle = 0.5 * (at.alpha[j] + at.beta[j]);
    if (at.nearest[j] > kFarOff) {
      c = {};
    } else if (width < kNarrow && std::abs(middle) < kFarOff) {
      c = narrow_cut(bank.x[j], at.deviation[j], middle, width);
    } else if (cuts.share[j] < kLeastShare) {
      // The cell lies where this model has no weight. Its nearer border becomes the measurement,
      // tight against both model and cell, so that the model returns instead of dividing 0 by 0.
      const double cell = high - low;
      c = {kLeastShare, at.alpha[j] > 0.0 ? low : high,
           std::min(0.01 * out.variance[j], 0.01 * cell * cell)};
    } else if (cuts.lost[j] <= 1e-9) {
      c.r = -1.0;
    }
    const bool says = c.r >= 0.0;
    out.share[j] = c.share;
    out.any = out.any || says;
    out.z[j] = says ? c.z : bank.x[j];
    out.r[j] = says ? std::max(c.r, 1e-16) : 1e30;  // 1e30: no information
  }
  return out;
}

Lanes truncate(ModelBank& bank, double low, double high) noexcept {
  const CellSight seen = see_cell(bank, low, high);
  if (seen.any) {
    bank.update(seen.z, seen.r);
  }
  return seen.share;
}

}  // namespace steadyrest::motion::online
