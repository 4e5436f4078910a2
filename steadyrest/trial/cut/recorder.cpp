// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <steadyrest/trial/cut/recorder.hpp>

// Figures over all samples, and a trace of bounded size. The trace keeps the worst sample of each
// group, so that thinning it never hides an error.
namespace steadyrest::trial::cut {
namespace {

using kernel::signal::Motion;

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

// By size: an outward error is as bad as an inward one.
bool worse(const Sample& a, const Sample& b) {
  return std::abs(a.contour_error_mm) > std::abs(b.contour_error_mm);
}

}  // namespace

Recorder::Recorder(const Config& config) : config_(config) {
  config_.max_points = std::max<std::size_t>(config_.max_points, 2);
  trace_.reserve(config_.max_points);
}

void Recorder::add(const Sample& sample) {
  add_to_figures(sample);
  add_to_trace(sample);
}

// Time and override changes count in all motion, errors only in cuts: a rapid leaves no surface.
void Recorder::add_to_figures(const Sample& sample) {
  if (!sample.after_end) {
    figures_.cycle_time_s = std::max(figures_.cycle_time_s, sample.time_s);
    // Nothing precedes the first sample, so it is no change.
    if (last_ratio_ >= 0.0 && sample.feed_ratio != last_ratio_) {
      ++figures_.override_changes;
    }
    last_ratio_ = sample.feed_ratio;
    time_by_reason_[sample.reason] += config_.cycle_s;
  }
  if (sample.motion != Motion::feed) {
    return;
  }
  const double error = std::abs(sample.contour_error_mm);
  ++figures_.samples;
  sum_of_squares_mm2_ += error * error;
  figures_.contour_error_max_mm = std::max(figures_.contour_error_max_mm, error);
  figures_.tracking_error_max_mm =
      std::max(figures_.tracking_error_max_mm, sample.tracking_error_mm);
  if (error > config_.limit_mm) {
    ++figures_.samples_over_limit;
  }
  if (sample.line >= worst_by_line_.size()) {
    worst_by_line_.resize(sample.line + 1, {.contour_error_mm = kNever});
  }
  LineError& worst = worst_by_line_[sample.line];
  if (std::isnan(worst.contour_error_mm) || error > std::abs(worst.contour_error_mm)) {
    worst = {.line = sample.line,
             .contour_error_mm = sample.contour_error_mm,
             .path_speed_mm_s = sample.path_speed_mm_s,
             .arc_radius_mm = sample.arc_radius_mm,
             .arc_length_mm = sample.arc_length_mm};
  }
}

void Recorder::add_to_trace(const Sample& sample) {
  if (in_group_ == 0) {
    if (trace_.size() == config_.max_points) {
      thin_trace();
    }
    trace_.push_back(sample);
  } else if (worse(sample, trace_.back())) {
    trace_.back() = sample;
  }
  in_group_ = (in_group_ + 1) % group_size_;
}

// However long the cut, the trace keeps its size: groups double.
void Recorder::thin_trace() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < trace_.size(); i += 2) {
    const bool second = i + 1 < trace_.size() && worse(trace_[i + 1], trace_[i]);
    trace_[kept++] = trace_[second ? i + 1 : i];
  }
  trace_.resize(kept);
  group_size_ *= 2;
}

// Times are counts of cycles, not sums of seconds: no rounding.
Figures Recorder::figures() const {
  Figures figures = figures_;
  const auto samples = static_cast<double>(figures.samples);
  figures.cutting_time_s = samples * config_.cycle_s;
  figures.over_limit_s = static_cast<double>(figures.samples_over_limit) * config_.cycle_s;
  figures.contour_error_rms_mm =
      figures.samples == 0 ? 0.0 : std::sqrt(sum_of_squares_mm2_ / samples);
  return figures;
}

std::vector<LineError> Recorder::line_errors() const {
  std::vector<LineError> errors;
  std::ranges::copy_if(worst_by_line_, std::back_inserter(errors),
                       [](const LineError& e) { return !std::isnan(e.contour_error_mm); });
  return errors;
}

}  // namespace steadyrest::trial::cut
