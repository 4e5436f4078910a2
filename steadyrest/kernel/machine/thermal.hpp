// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

/// The thermal passport of a machine as values; for the law that uses them see thermal/README.md.
namespace steadyrest::kernel::machine {

/// One thermal mode of one displacement: x' = (G(n) − x)/τ.
///
/// The level G is a table over the spindle's speed (straight between its points), or a polynomial
/// Σ polynomial_mm[p]·(n/1000 rpm)^(p+1); not both.
struct ThermalMode {
  double tau_s = 3600.0;    ///< time constant while the spindle turns
  double rest_tau_s = 0.0;  ///< while it is stopped; 0 = `tau_s`
  std::vector<double> speed_rev_s;
  std::vector<double> level_mm;       ///< as many as speeds
  std::vector<double> polynomial_mm;  ///< coefficients of n, n², …, n in 1000 rev/min
  double cutting_ratio = 1.0;         ///< of the level, during feed moves
  double coolant_ratio = 1.0;         ///< of the level, with coolant
  double feed_s = 0.0;                ///< added to the level per mm/s of feed: mm/(mm/s)
  double tau_sd_ratio = 0.0;          ///< standard deviation of ln τ
  double state_mm = 0.0;              ///< x at the passport's `state_s`

  friend bool operator==(const ThermalMode&, const ThermalMode&) = default;
};

/// Surroundings: displacement gain·(T_lagged − reference), T_lagged' = (T − T_lagged)/τ.
struct ThermalAmbient {
  std::string sensor = "ambient";  ///< its column in a log
  double tau_s = 0.0;              ///< 0 = no lag
  double gain_mm_k = 0.0;
  double reference_c = 20.0;
  double state_c = 20.0;  ///< T_lagged at the passport's `state_s`

  friend bool operator==(const ThermalAmbient&, const ThermalAmbient&) = default;
};

/// The displacement of one axis: the sum of its modes and of the effect of the surroundings.
struct ThermalAxis {
  std::string name = "Z";  ///< an axis of the machine, or a displacement that no axis corrects
  double noise_mm = 0.0;   ///< RMS of one reading
  /// What the model cannot explain: a first-order process of this RMS and time constant.
  double drift_mm = 0.0;
  double drift_tau_s = 3600.0;
  double drift_state_mm = 0.0;   ///< its value at the passport's `state_s`
  double max_speed_rev_s = 0.0;  ///< fastest speed fitted; 0 = not known
  double zero_mm = 0.0;          ///< the log's gauge reading with no displacement at all
  std::vector<ThermalMode> mode;
  std::vector<ThermalAmbient> ambient;
  /// Lower triangle, row by row, of the covariance of the linear parameters: for each mode its
  /// levels or coefficients in µm, then the ambient gains in µm/K. Empty: taken as known.
  std::vector<double> covariance;

  [[nodiscard]] std::size_t parameters() const noexcept {
    std::size_t count = ambient.size();
    for (const ThermalMode& m : mode) {
      count += m.level_mm.size() + m.polynomial_mm.size();
    }
    return count;
  }

  friend bool operator==(const ThermalAxis&, const ThermalAxis&) = default;
};

/// Bounds of the passport: they fix the sizes of what runs in the cycle.
inline constexpr std::size_t kMaxThermalModes = 4;
inline constexpr std::size_t kMaxThermalAmbients = 64;
inline constexpr std::size_t kMaxThermalLevels = 64;

struct Thermal {
  bool enabled = false;  ///< the layer corrects on line
  /// Shares k of the tolerance that the machine's heat may take, by level: k0, k1, …
  std::vector<double> share = {1.0, 0.7, 0.5, 0.35};
  std::uint32_t level = 0;           ///< the level in force
  double max_offset_mm = 0.1;        ///< largest correction
  double slope_mm_s = 0.001 / 60.0;  ///< of the on-line correction
  double retract_slope_mm_s = 0.0;   ///< while no tool is in the cut; 0 = `slope_mm_s`
  double state_s = 0.0;              ///< time in the log to which the states belong
  std::vector<ThermalAxis> axis;

  /// The temperature sensors of all axes, each once, in order of first mention;
  /// signal::Frame::temperature_c uses the same order.
  [[nodiscard]] std::vector<std::string> sensors() const {
    std::vector<std::string> names;
    for (const ThermalAxis& a : axis) {
      for (const ThermalAmbient& ambient : a.ambient) {
        if (std::ranges::find(names, ambient.sensor) == names.end()) {
          names.push_back(ambient.sensor);
        }
      }
    }
    return names;
  }

  /// Modes and ambient inputs of all axes: axis by axis, its modes first.
  [[nodiscard]] std::size_t terms() const noexcept {
    std::size_t count = 0;
    for (const ThermalAxis& a : axis) {
      count += a.mode.size() + a.ambient.size();
    }
    return count;
  }

  friend bool operator==(const Thermal&, const Thermal&) = default;
};

}  // namespace steadyrest::kernel::machine
