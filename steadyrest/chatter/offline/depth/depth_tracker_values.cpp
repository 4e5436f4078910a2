// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/chatter/offline/depth/depth_tracker.hpp>

// The values of g: by a disc where one holds, else by the matrices themselves.
namespace steadyrest::chatter::offline {
namespace {

using Complex = std::complex<double>;

constexpr double kSpan = 0.2;  ///< of the depth, for which one disc is to serve
constexpr double kLeastSpan = 0.02;
constexpr double kSpare = 1.05;  ///< of |z| over what is needed
// Matrices for a third of |z| need fewer pieces and terms; a search from depth 0 spends most of its
// time at small |z|.
constexpr double kLevelRatio = 3.0;

}  // namespace

const PassMatrix& DepthTracker::pass(double z_mm, double depth_mm) {
  if (each_depth_) {
    if (!pass_[0] || depth_mm != made_for_mm_ || pass_[0]->most_z_mm() < z_mm) {
      // A disc belongs to the matrices that it was made from.
      disc_.reset();
      made_for_mm_ = depth_mm;
      pass_[0] = std::make_unique<PassMatrix>(process_, speed_rev_s_, kSpare * z_mm, depth_mm);
    }
    return *pass_[0];
  }
  // |z| = a·|1 − ξ| ≤ a·(1 + |ξ|); refine() lets |ξ| reach twice kMostXi.
  double most = (1.0 + 2.0 * kMostXi) * most_depth_mm_;
  std::size_t level = 0;
  while (level + 1 < kLevels && z_mm <= most / kLevelRatio) {
    most /= kLevelRatio;
    ++level;
  }
  if (!pass_[level]) {
    pass_[level] = std::make_unique<PassMatrix>(process_, speed_rev_s_, most, depth_mm);
  }
  return *pass_[level];
}

void DepthTracker::aim(double size, double depth_mm) {
  const bool same = !each_depth_ || depth_mm == made_for_mm_;
  if (same && disc_ && disc_->holds(depth_mm, size * depth_mm)) {
    return;
  }
  // A smaller disc has smaller values on its rim and needs fewer terms; none at all is no fault,
  // since g() then takes the matrices.
  for (double span = each_depth_ ? kLeastSpan : kSpan; span >= kLeastSpan; span *= 0.25) {
    // Ahead of the present depth: depths are asked for in rising order. z = a·(1 − ξ) for all a of
    // the span and |ξ| ≤ size lies within this disc.
    const double center = (1.0 + 0.5 * span) * depth_mm;
    const double radius = 0.5 * span * depth_mm + size * (1.0 + span) * depth_mm;
    disc_ = PassDisc::make(pass(center + radius, depth_mm), center, radius, terms_);
    if (disc_) {
      // The next disc starts from as many terms as this one took.
      terms_ = disc_->terms();
      return;
    }
  }
}

void DepthTracker::g(std::span<const Complex> xi, double depth_mm, std::span<Complex> out) {
  double square = 0.0;
  for (const Complex& x : xi) {
    square = std::max(square, std::norm(x));
  }
  const double size = std::sqrt(square);
  const bool same = !each_depth_ || depth_mm == made_for_mm_;
  if (same && disc_ && disc_->holds(depth_mm, size * depth_mm)) {
    disc_->g(xi, depth_mm, out);
    return;
  }
  // Without a disc: the product of all pieces at each z.
  const PassMatrix& matrix = pass((1.0 + size) * depth_mm, depth_mm);
  for (std::size_t k = 0; k < xi.size(); k += PassMatrix::kLanes) {
    PassMatrix::Lanes lanes;
    std::copy_n(&xi[k], lanes.size(), lanes.begin());
    std::ranges::copy(matrix.g_lanes(lanes, depth_mm), &out[k]);
  }
}

}  // namespace steadyrest::chatter::offline
