// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/nc/interpret/state/move.hpp>
#include <steadyrest/nc/plan/path/planned_path.hpp>
#include <steadyrest/nc/plan/time/cyclogram.hpp>

namespace steadyrest::nc::plan {

/// Where the time of a program goes.
struct ProgramTime {
  struct Tool {
    std::int64_t number = 0;  ///< 0 before the first tool change
    double seconds = 0.0;     ///< including its change
  };
  double total_s = 0.0;
  double cut_s = 0.0;  ///< feed, thread, tap and probe moves
  double rapid_s = 0.0;
  double dwell_s = 0.0;
  double tool_change_s = 0.0;
  double spindle_wait_s = 0.0;
  double cut_mm = 0.0;
  double rapid_mm = 0.0;
  std::uint64_t moves = 0;
  std::vector<Tool> tools;            ///< in the order of use, one entry for each change
  std::vector<Transition> cyclogram;  ///< what the machine does, in order
  std::vector<double> line_s;  ///< by line of the program (index 0 unused); repeated lines add up
};

/// Times a program by running it through the planner and the interpolator, period by period where
/// anything changes: what goes on at one speed, and a dwell, are passed at once.
///
/// Holds a moving window over the path: memory does not grow with the path; only `line_s` (8 bytes
/// per line), `tools` and `cyclogram` grow. The spindle ramps at machine.spindle.acceleration.
/// Resolution: one interpolator period for each stop.
class ProgramTimer final : public interpret::Sink {
 public:
  /// Refuses a machine that the interpolator refuses. `machine` must outlive the timer.
  static kernel::outcome::Result<ProgramTimer> make(const kernel::machine::Machine& machine);
  ProgramTimer(ProgramTimer&& other) noexcept;
  ~ProgramTimer() override;

  void on_move(const interpret::Move& move) override;
  void on_event(const interpret::Event& event) override;
  /// The result; call once after the last move. Refuses what the planner refuses, and a program
  /// longer than `kMost_s`: at the programmed feeds before it is run, naming the line (PathStream);
  /// at these overrides naming the line where the limit was passed.
  [[nodiscard]] kernel::outcome::Result<ProgramTime> take();

  /// Called with a move's line when the machine reaches it, and the time since the program's start;
  /// `line_s` then stays empty, so memory does not grow with the lines.
  using Arrival = std::function<void(std::uint32_t line, double time_s)>;
  void set_arrival(Arrival arrival);

  /// Feed, rapid and spindle override in force throughout; 1 without.
  void set_overrides(double feed_ratio, double rapid_ratio, double spindle_ratio);

  static constexpr double kMost_s = kLongestProgram_s;

 private:
  class Runner;
  explicit ProgramTimer(std::unique_ptr<Runner> runner);
  std::unique_ptr<Runner> runner_;
};

}  // namespace steadyrest::nc::plan
