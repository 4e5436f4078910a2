// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/trial/cut/report_data.hpp>
#include <steadyrest/trial/cut/vibration_record.hpp>

namespace steadyrest::trial::cut {

/// What one cycle of a cut contributes to the record. Errors are those of the true tool, not of the
/// encoders.
struct Sample {
  double time_s = 0.0;
  kernel::signal::Point position_mm{};
  double path_position_mm = 0.0;
  double contour_error_mm = 0.0;   ///< signed, see contour/online/contour_error.hpp
  double tracking_error_mm = 0.0;  ///< distance from the commanded to the true point
  double feed_ratio = 1.0;         ///< override in force
  double path_speed_mm_s = 0.0;    ///< commanded
  double arc_radius_mm = 0.0;      ///< of the path at the tool; 0: straight
  double arc_length_mm = 0.0;      ///< of that arc
  std::uint32_t line = 0;          ///< the tool's line, which lags the control's
  kernel::signal::Motion motion = kernel::signal::Motion::idle;
  kernel::outcome::Reason reason = kernel::outcome::Reason::none;
  bool after_end = false;  ///< the program has ended, the tool is still on its way
};

/// The layer heard chatter and requested another spindle speed.
struct HeardChatter {
  double time_s = 0.0;
  double frequency_hz = 0.0;
  double spindle_ratio = 1.0;  ///< requested from then on
};

/// Largest contour error on one line of the program, and the feed there.
struct LineError {
  std::uint32_t line = 0;
  double contour_error_mm = 0.0;  ///< signed
  double path_speed_mm_s = 0.0;
  double arc_radius_mm = 0.0;  ///< 0: straight
  double arc_length_mm = 0.0;
};

/// Takes every cycle of a cut; keeps exact figures and a trace thinned to a bounded number of
/// points: of each thinned group the sample with the largest contour error.
class Recorder {
 public:
  struct Config {
    double limit_mm = 0.010;
    double cycle_s = 0.001;          ///< time that one sample represents
    std::size_t max_points = 16384;  ///< at least 2
  };

  explicit Recorder(const Config& config);

  void add(const Sample& sample);

  [[nodiscard]] Figures figures() const;
  /// At most max_points samples in order of time.
  [[nodiscard]] const std::vector<Sample>& trace() const { return trace_; }
  /// Seconds that the layer spent on each reason.
  [[nodiscard]] const std::map<kernel::outcome::Reason, double>& time_by_reason() const {
    return time_by_reason_;
  }
  /// The quality of the layer's estimates of the axes' motion; empty without a layer.
  void set_motion(std::vector<MotionFigures> motion) { motion_ = std::move(motion); }
  [[nodiscard]] const std::vector<MotionFigures>& motion() const { return motion_; }
  /// The tool's vibration; empty where the machine cut air.
  void set_vibration(VibrationRecord vibration) { vibration_ = std::move(vibration); }
  [[nodiscard]] const std::optional<VibrationRecord>& vibration() const { return vibration_; }
  /// In order of time; each ratio differs from the one before.
  void add_heard(const HeardChatter& heard) {
    if (heard_.empty() ? heard.spindle_ratio != 1.0
                       : heard_.back().spindle_ratio != heard.spindle_ratio) {
      heard_.push_back(heard);
    }
  }
  [[nodiscard]] const std::vector<HeardChatter>& heard() const { return heard_; }
  /// Probe readings that the thermal room received, in order of time.
  void add_probe(ProbeFigures probe) { probes_.push_back(std::move(probe)); }
  [[nodiscard]] const std::vector<ProbeFigures>& probes() const { return probes_; }
  /// By line number of the program; only lines with cutting motion.
  [[nodiscard]] std::vector<LineError> line_errors() const;

 private:
  void add_to_figures(const Sample& sample);
  void add_to_trace(const Sample& sample);
  void thin_trace();

  Config config_;
  Figures figures_;
  double sum_of_squares_mm2_ = 0.0;
  double last_ratio_ = -1.0;
  std::map<kernel::outcome::Reason, double> time_by_reason_;
  std::vector<LineError> worst_by_line_;  ///< the error NaN where the line never cut
  std::vector<Sample> trace_;
  std::vector<MotionFigures> motion_;
  std::optional<VibrationRecord> vibration_;
  std::vector<HeardChatter> heard_;
  std::vector<ProbeFigures> probes_;
  std::size_t group_size_ = 1;
  std::size_t in_group_ = 0;
};

}  // namespace steadyrest::trial::cut
