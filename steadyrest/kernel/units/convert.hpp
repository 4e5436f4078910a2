// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

/// Conversions at the borders. Inside there is one system: mm, s, N, kg, rev/s, rad, °C, ratios
/// with 1.0 = 100 %.
namespace steadyrest::kernel::units {

inline constexpr double kMmPerInch = 25.4;

[[nodiscard]] constexpr double mm_s_from_mm_min(double feed_mm_min) noexcept {
  return feed_mm_min / 60.0;
}
[[nodiscard]] constexpr double mm_min_from_mm_s(double feed_mm_s) noexcept {
  return feed_mm_s * 60.0;
}
[[nodiscard]] constexpr double rev_s_from_rpm(double speed_rpm) noexcept {
  return speed_rpm / 60.0;
}
[[nodiscard]] constexpr double rpm_from_rev_s(double speed_rev_s) noexcept {
  return speed_rev_s * 60.0;
}
[[nodiscard]] constexpr double rad_from_deg(double angle_deg) noexcept {
  return angle_deg * (std::numbers::pi / 180.0);
}
[[nodiscard]] constexpr double deg_from_rad(double angle_rad) noexcept {
  return angle_rad * (180.0 / std::numbers::pi);
}
[[nodiscard]] constexpr double mm_from_um(double length_um) noexcept {
  return length_um * 1e-3;
}
[[nodiscard]] constexpr double um_from_mm(double length_mm) noexcept {
  return length_mm * 1e3;
}
[[nodiscard]] constexpr double s_from_ms(double time_ms) noexcept {
  return time_ms * 1e-3;
}
[[nodiscard]] constexpr double s_from_ns(double time_ns) noexcept {
  return time_ns * 1e-9;
}
[[nodiscard]] constexpr double ratio_from_percent(double percent) noexcept {
  return percent * 0.01;
}
[[nodiscard]] constexpr double percent_from_ratio(double ratio) noexcept {
  return ratio * 100.0;
}
/// Servo gain: 1 (m/min)/mm = 1000/60 1/s.
[[nodiscard]] constexpr double gain_1_s_from_m_min_mm(double gain_m_min_mm) noexcept {
  return gain_m_min_mm * (1000.0 / 60.0);
}

}  // namespace steadyrest::kernel::units
