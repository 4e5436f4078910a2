// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <steadyrest/chatter/offline/process/cutting_coefficients.hpp>
#include <steadyrest/kernel/units/constants.hpp>

namespace steadyrest::chatter::offline {
namespace {

using kernel::units::kTurn;

// Corners closer than this are one corner, apart by rounding.
constexpr double kSameCorner = 1e-10;  ///< rad

double within_turn(double angle) noexcept {
  const double turns = std::floor(angle / kTurn);
  const double out = angle - turns * kTurn;
  // floor() of an angle just below 0 may round to a whole turn.
  return out >= kTurn ? out - kTurn : out;
}

/// Antiderivatives of sin², sin·cos and cos².
Eigen::Vector3d primitive(double phi) noexcept {
  const double s2 = std::sin(2.0 * phi);
  return {0.5 * phi - 0.25 * s2, -0.25 * std::cos(2.0 * phi), 0.5 * phi + 0.25 * s2};
}

}  // namespace

CuttingCoefficients::CuttingCoefficients(const Process& process, double depth_mm)
    : cut_(process.cut),
      entry_rad_(process.entry_rad()),
      exit_rad_(process.exit_rad()),
      repeats_rad_(process.even_pitch() ? process.pitch_rad(0) : kTurn) {
  if (cut_.operation == Operation::milling) {
    // The top of a helical edge trails its tip by a·tan β over the radius.
    lag_rad_ = 2.0 * depth_mm * std::tan(process.tool.helix_rad) / process.tool.diameter_mm;
  }
  // C/v with v = π·D·n, here at n = 1 rev/s.
  damping_n_s_ = cut_.process_damping_n_mm / (std::numbers::pi * process.tool.diameter_mm);
  double offset = 0.0;
  for (std::size_t j = 0; j < process.tool.teeth; ++j) {
    // Tooth 0 is the reference; pitch_rad(j) is the angle from tooth j to the one in front of it.
    offset += j == 0 ? 0.0 : process.pitch_rad(j);
    offset_rad_.push_back(offset);
  }
}

Eigen::Vector3d CuttingCoefficients::squares(std::size_t tooth, double angle_rad) const noexcept {
  // Straight edge: the mean over the height below would be 0/0.
  if (lag_rad_ < 1e-9) {
    const double phi = within_turn(angle_rad - offset_rad_[tooth]);
    if (phi < entry_rad_ || phi > exit_rad_) {
      return Eigen::Vector3d::Zero();
    }
    const double s = std::sin(phi);
    const double c = std::cos(phi);
    return {s * s, s * c, c * c};
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  // The edge covers [φ − lag, φ]; a long edge may wind round the tool more than once.
  const double tip = within_turn(angle_rad - offset_rad_[tooth]);
  // Mean over the edge's height of each slice's contribution at its own angle.
  for (double shift = 0.0; shift > -lag_rad_ - kTurn; shift -= kTurn) {
    const double high = std::min(tip, exit_rad_ + shift);
    const double low = std::max(tip - lag_rad_, entry_rad_ + shift);
    if (high > low) {
      sum += primitive(high) - primitive(low);
    }
  }
  return sum / lag_rad_;
}

Eigen::Matrix2d CuttingCoefficients::stiffness(std::size_t tooth, double angle_rad) const noexcept {
  Eigen::Matrix2d h;
  if (cut_.operation == Operation::turning) {
    // Turning: the chip is measured only along x, so displacements along y do not enter.
    h << cut_.radial_n_mm2, 0.0, cut_.tangential_n_mm2, 0.0;
    return h;
  }
  const Eigen::Vector3d q = squares(tooth, angle_rad);
  const double kt = cut_.tangential_n_mm2;
  const double kr = cut_.radial_n_mm2;
  // n = (sin φ, cos φ) is the direction of the chip, t = (cos φ, −sin φ) that of the cut; H = u·nᵀ
  // with u = kt·t + kr·n, and q = (sin², sin·cos, cos²) carries the products over the edge.
  h << kt * q[1] + kr * q[0], kt * q[2] + kr * q[1], -kt * q[0] + kr * q[1], -kt * q[1] + kr * q[2];
  return h;
}

Eigen::Matrix2d CuttingCoefficients::damping(std::size_t tooth, double angle_rad) const noexcept {
  Eigen::Matrix2d p = Eigen::Matrix2d::Zero();
  if (damping_n_s_ == 0.0) {
    return p;
  }
  if (cut_.operation == Operation::turning) {
    p(0, 0) = damping_n_s_;
    return p;
  }
  const Eigen::Vector3d q = squares(tooth, angle_rad);
  // n·nᵀ: damping acts only along the chip's thickness.
  p << q[0], q[1], q[1], q[2];
  return damping_n_s_ * p;
}

std::vector<double> CuttingCoefficients::corners_rad(std::size_t tooth) const {
  if (cut_.operation == Operation::turning) {
    return {};
  }
  std::vector<double> out;
  // The tip and, a lag later, the top of the edge cross each border; H has a kink at all four.
  for (const double border : {entry_rad_, exit_rad_}) {
    out.push_back(within_turn(border + offset_rad_[tooth]));
    if (lag_rad_ >= 1e-9) {
      out.push_back(within_turn(border + lag_rad_ + offset_rad_[tooth]));
    }
  }
  return out;
}

// H_j = (Kr·I + Kt·J)·n·nᵀ with J a quarter turn, and ‖Kr·I + Kt·J‖ = |(Kt, Kr)|: what remains is
// the larger eigenvalue of Σ n·nᵀ over the m teeth that cut, (m + |Σ e^{2iφ_j}|)/2. It stays the
// same until a tooth enters or leaves, since all turn together. A helical edge is a mean of
// straight ones, and the norm of a mean is at most the largest norm.
double CuttingCoefficients::most_at_once() const {
  if (cut_.operation == Operation::turning) {
    return static_cast<double>(teeth());
  }
  std::vector<double> corner;
  // Within a pitch, evenly pitched teeth all have the same corners.
  const std::size_t different = repeats_rad_ < kTurn ? 1 : teeth();
  for (std::size_t j = 0; j < different; ++j) {
    for (const double border : {entry_rad_, exit_rad_}) {
      corner.push_back(std::fmod(within_turn(border + offset_rad_[j]), repeats_rad_));
    }
  }
  std::ranges::sort(corner);
  corner.push_back(corner.front() + repeats_rad_);
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < corner.size(); ++i) {
    if (corner[i + 1] - corner[i] < kSameCorner) {
      continue;
    }
    const double middle = 0.5 * (corner[i] + corner[i + 1]);
    double cutting = 0.0;
    std::complex<double> twice = 0.0;
    for (const double offset : offset_rad_) {
      const double phi = within_turn(middle - offset);
      if (phi >= entry_rad_ && phi <= exit_rad_) {
        cutting += 1.0;
        twice += std::polar(1.0, 2.0 * phi);
      }
    }
    most = std::max(most, 0.5 * (cutting + std::abs(twice)));
  }
  return most;
}

}  // namespace steadyrest::chatter::offline
