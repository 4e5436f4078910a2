// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <steadyrest/chatter/offline/speed_profile.hpp>

namespace steadyrest::chatter::offline {

namespace {
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kMostSteps = 80;
}  // namespace

SpeedProfile::SpeedProfile(double mean_rev_s, const Modulation& modulation)
    : law_(modulation.law, modulation.seed),
      mean_rad_s_(kTurn * mean_rev_s),
      rva_(modulation.rva),
      constant_(modulation.law == online::Law::constant || modulation.rva == 0.0) {
  if (constant_) {
    return;
  }
  period_rad_ = kTurn / modulation.rvf;
  for (std::size_t k = 0; k < law_.corner_count(); ++k) {
    const double u = law_.corners()[k];
    corners_rad_.push_back(period_rad_ * (u + rva_ * law_.integral(u)));
  }
}

/// θ(u) rises: Newton's steps, halved into the bracket when they leave it.
double SpeedProfile::phase(double angle_rad) const noexcept {
  const double want = angle_rad / period_rad_;
  double low = 0.0;
  double high = 1.0;
  double u = want;
  for (int i = 0; i < kMostSteps && high - low > 1e-16; ++i) {
    const double off = u + rva_ * law_.integral(u) - want;
    (off > 0.0 ? high : low) = u;
    double next = u - off / (1.0 + rva_ * law_.at(u));
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - u) < 1e-16) {
      break;
    }
    u = next;
  }
  return u;
}

double SpeedProfile::speed_rad_s(double angle_rad) const noexcept {
  if (constant_) {
    return mean_rad_s_;
  }
  const double within = angle_rad - std::floor(angle_rad / period_rad_) * period_rad_;
  return mean_rad_s_ * (1.0 + rva_ * law_.at(phase(within)));
}

double SpeedProfile::time_s(double angle_rad) const noexcept {
  if (constant_) {
    return angle_rad / mean_rad_s_;
  }
  const double periods = std::floor(angle_rad / period_rad_);
  return (periods + phase(angle_rad - periods * period_rad_)) * period_rad_ / mean_rad_s_;
}

}  // namespace steadyrest::chatter::offline
