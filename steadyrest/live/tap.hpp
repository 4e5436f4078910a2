// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <steadyrest/kernel/rt/ring.hpp>
#include <steadyrest/kernel/rt/snapshot.hpp>
#include <steadyrest/kernel/signal/frame.hpp>
#include <steadyrest/live/live_status.hpp>

namespace steadyrest::live {

/// What is drawn of a cycle.
struct TapSample {
  std::uint64_t cycle = 0;
  double time_s = 0.0;
  kernel::signal::Point position_mm{};  ///< of the first three axes, by their encoders
  kernel::signal::Point following_mm{};
  bool error_known = false;
  double contour_error_mm = 0.0;
  double feed_asked_ratio = 1.0;
  double feed_ratio = 1.0;
  double feed_effective_ratio = 1.0;
  double feed_panel_ratio = 1.0;
  double path_speed_mm_s = 0.0;
  double spindle_rev_s = 0.0;
};

/// The commanded path from the present point on, as a polyline; empty where it is not known.
struct PathAhead {
  static constexpr std::size_t kMost = 64;
  std::size_t count = 0;
  double from_mm = 0.0;  ///< path length of the first point
  double step_mm = 0.0;
  std::array<kernel::signal::Point, kMost> point_mm{};
};

/// What each step of the feed override would give (supervisor's preview); none where the layer sees
/// no path ahead.
struct StepErrors {
  static constexpr std::size_t kMost = contour::online::Forecast::kMaxTable;
  struct Step {
    double ratio = 0.0;
    double held_mm = 0.0;    ///< in force from now on; NaN: the path is not known far enough
    double change_mm = 0.0;  ///< gone to now, and left after a decision
  };
  std::size_t count = 0;
  std::array<Step, kMost> step{};
};

/// The thermal room as it is, to be run on from there.
struct HeatNow {
  bool on = false;
  double time_s = 0.0;  ///< of the frame
  thermal::online::OffsetGovernor::State state;
  kernel::signal::AxisValues offset_mm{};  ///< that the envelope let pass
};

/// Carries what each cycle has seen to those who draw it: the cycle puts it in, one other thread
/// takes it out. put() runs in the cycle: bounded, no allocation, no lock. Nobody who takes too
/// late delays it: what finds no room is lost and counted.
class Tap {
 public:
  Tap() : samples_(std::make_unique<Samples>()), readings_(std::make_unique<Readings>()) {}

  /// Only while somebody watches; of the thread that takes. When watching begins, what is left of
  /// an earlier time is dropped.
  void watch(bool on) noexcept;

  /// In the cycle, with the frame as it was read: its path lies there.
  void put(const LiveStatus& status, const kernel::signal::Frame& frame) noexcept;

  /// In the cycle, after the write: while somebody watches, one step of the override in turn, by
  /// one forecast; not in a cycle that decides, unless all of them do. The layer stays as it is.
  void look_at_steps(const LiveStatus& status, const supervisor::Supervisor& layer) noexcept;

  /// In the cycle, watched or not: a copy of the thermal room once a second.
  void look_at_heat(const LiveStatus& status, const supervisor::Supervisor& layer) noexcept;

  /// All samples since the last time, and how many were lost in all.
  std::uint64_t take(std::vector<TapSample>& into);
  /// The vibration since the last time, oldest first, and its rate in Hz. Readings that found no
  /// room are left out. Of the thread that takes.
  double take_vibration(std::vector<double>& into);
  /// The newest; of the thread that takes.
  [[nodiscard]] const PathAhead& ahead() noexcept { return ahead_.load(); }
  [[nodiscard]] const StepErrors& steps() noexcept { return steps_.load(); }
  [[nodiscard]] const HeatNow& heat() noexcept { return heat_.load(); }

 private:
  static constexpr std::size_t kSamples = 4096;
  using Samples = kernel::rt::Ring<TapSample, kSamples>;

  /// A second at 50 kHz: the newest is lost when it is full, which leaves a gap in the signal.
  static constexpr std::size_t kReadings = 65'536;
  using Readings = kernel::rt::Ring<double, kReadings>;

  void put_vibration(const kernel::signal::Frame& frame) noexcept;

  std::unique_ptr<Samples> samples_;
  std::unique_ptr<Readings> readings_;
  std::atomic<double> rate_hz_{0.0};
  kernel::rt::Snapshot<PathAhead> ahead_;
  PathAhead next_;
  kernel::rt::Snapshot<StepErrors> steps_;
  StepErrors looked_;
  std::size_t turn_ = 0;      ///< looks of this round
  bool steps_shown_ = false;  ///< those in steps_ are of now
  bool decided_ = false;      ///< the cycle before
  kernel::rt::Snapshot<HeatNow> heat_;
  HeatNow heat_next_;
  std::atomic<bool> watched_{false};
  std::atomic<std::uint64_t> lost_{0};
  std::uint32_t since_ahead_ = 0;
};

}  // namespace steadyrest::live
