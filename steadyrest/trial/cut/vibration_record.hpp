// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <steadyrest/sim/cut/cutting_vibration.hpp>
#include <steadyrest/trial/cut/report_data.hpp>

namespace steadyrest::trial::cut {

/// The tool's vibration in a cut: figures over the whole cut, and its course in at most
/// `max_points` equal stretches of time.
class VibrationRecord {
 public:
  explicit VibrationRecord(std::size_t max_points = 2048);

  void add(double time_s, double spindle_rev_s, const sim::CuttingVibration::Cycle& cycle);

  /// Empty where nothing was cut.
  [[nodiscard]] std::optional<VibrationFigures> figures() const;
  [[nodiscard]] std::vector<VibrationPoint> course() const;

 private:
  struct Stretch {
    double time_s = 0.0;
    double cutting_s = 0.0;
    double peak_mm = 0.0;
    double unforced_mm2_s = 0.0;
    double spindle_rev_s = 0.0;
    std::size_t cycles = 0;
    void add(const Stretch& next);
  };
  void halve();

  std::size_t max_points_;
  std::size_t per_stretch_ = 1;  ///< cycles
  sim::CuttingVibration::Cycle sum_;
  std::vector<Stretch> course_;
};

}  // namespace steadyrest::trial::cut
