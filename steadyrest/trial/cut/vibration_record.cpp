// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/units/convert.hpp>
#include <steadyrest/trial/cut/vibration_record.hpp>

namespace steadyrest::trial::cut {
namespace {

using kernel::units::rpm_from_rev_s;
using kernel::units::um_from_mm;

/// RMS over the time; rounding may leave a square a little below 0.
double rms(double square, double seconds) {
  return seconds > 0.0 ? std::sqrt(std::max(square, 0.0) / seconds) : 0.0;
}

}  // namespace

// At least two: halving must leave room for one more.
VibrationRecord::VibrationRecord(std::size_t max_points)
    : max_points_(std::max<std::size_t>(max_points, 2)) {}

// Means weighted by the number of cycles, peaks by the larger, energies by sum.
void VibrationRecord::Stretch::add(const Stretch& next) {
  spindle_rev_s = (spindle_rev_s * static_cast<double>(cycles) +
                   next.spindle_rev_s * static_cast<double>(next.cycles)) /
                  static_cast<double>(cycles + next.cycles);
  cutting_s += next.cutting_s;
  peak_mm = std::max(peak_mm, next.peak_mm);
  unforced_mm2_s += next.unforced_mm2_s;
  cycles += next.cycles;
}

// Neighbours merge pairwise: peaks as the larger, means by weight, so no peak is lost.
void VibrationRecord::halve() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < course_.size(); i += 2) {
    Stretch stretch = course_[i];
    if (i + 1 < course_.size()) {
      stretch.add(course_[i + 1]);
    }
    course_[kept++] = stretch;
  }
  course_.resize(kept);
  per_stretch_ *= 2;
}

void VibrationRecord::add(double time_s, double spindle_rev_s,
                          const sim::CuttingVibration::Cycle& cycle) {
  const Stretch now{.time_s = time_s,
                    .cutting_s = cycle.cutting_s,
                    .peak_mm = cycle.peak_mm,
                    .unforced_mm2_s = cycle.unforced_mm2_s,
                    .spindle_rev_s = spindle_rev_s,
                    .cycles = 1};
  if (course_.empty() || course_.back().cycles >= per_stretch_) {
    // However long the cut, the record keeps its size: neighbours merge.
    if (course_.size() == max_points_) {
      halve();
    }
    course_.push_back(now);
  } else {
    course_.back().add(now);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    sum_.sum_mm_s[i] += cycle.sum_mm_s[i];
    sum_.square_mm2_s[i] += cycle.square_mm2_s[i];
  }
  sum_.cutting_s += cycle.cutting_s;
  sum_.unforced_mm2_s += cycle.unforced_mm2_s;
  sum_.peak_mm = std::max(sum_.peak_mm, cycle.peak_mm);
  sum_.force_peak_n = std::max(sum_.force_peak_n, cycle.force_peak_n);
  sum_.power_peak_w = std::max(sum_.power_peak_w, cycle.power_peak_w);
  sum_.chip_peak_mm = std::max(sum_.chip_peak_mm, cycle.chip_peak_mm);
  // Cycles without a finished wall say nothing about it.
  if (cycle.walls > 0) {
    const bool first = sum_.walls == 0;
    sum_.wall_low_mm = first ? cycle.wall_low_mm : std::min(sum_.wall_low_mm, cycle.wall_low_mm);
    sum_.wall_high_mm =
        first ? cycle.wall_high_mm : std::max(sum_.wall_high_mm, cycle.wall_high_mm);
    sum_.wall_sum_mm += cycle.wall_sum_mm;
    sum_.walls += cycle.walls;
  }
}

// No cutting, no figures: zeros would look like a quiet cut.
std::optional<VibrationFigures> VibrationRecord::figures() const {
  const double seconds = sum_.cutting_s;
  if (!(seconds > 0.0)) {
    return std::nullopt;
  }
  double variance = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    // Variance as Σx² − x̄²·T: the mean is the static deflection, which is no vibration.
    const double mean = sum_.sum_mm_s[i] / seconds;
    variance += sum_.square_mm2_s[i] - mean * mean * seconds;
  }
  VibrationFigures out{.rms_um = um_from_mm(rms(variance, seconds)),
                       .peak_um = um_from_mm(sum_.peak_mm),
                       .unforced_rms_um = um_from_mm(rms(sum_.unforced_mm2_s, seconds)),
                       .force_peak_n = sum_.force_peak_n,
                       .power_peak_w = sum_.power_peak_w,
                       .chip_peak_um = um_from_mm(sum_.chip_peak_mm),
                       .surface_error_um = std::nullopt,
                       .surface_range_um = std::nullopt};
  if (sum_.walls > 0) {
    out.surface_error_um = um_from_mm(sum_.wall_sum_mm / static_cast<double>(sum_.walls));
    out.surface_range_um = um_from_mm(sum_.wall_high_mm - sum_.wall_low_mm);
  }
  return out;
}

std::vector<VibrationPoint> VibrationRecord::course() const {
  std::vector<VibrationPoint> points;
  points.reserve(course_.size());
  for (const Stretch& s : course_) {
    points.push_back({.time_s = s.time_s,
                      .peak_um = um_from_mm(s.peak_mm),
                      .unforced_um = um_from_mm(rms(s.unforced_mm2_s, s.cutting_s)),
                      .speed_rpm = rpm_from_rev_s(s.spindle_rev_s)});
  }
  return points;
}

}  // namespace steadyrest::trial::cut
