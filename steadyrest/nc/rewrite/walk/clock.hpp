// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite {

/// A program's times from a clock, so that it need not be timed again.
struct KnownTimes {
  std::map<std::uint32_t, double> line_s;  ///< by the line, which is executed once
  double program_s = 0.0;
};

/// When the machine reaches the lines of a walk: the times of segment_timer, asked for only at
/// chosen lines, so that memory does not grow with the program.
class Clock {
 public:
  /// Called for each chosen line, in order, with the time at which its first move begins.
  using Told = std::function<void(std::uint64_t ticket, double time_s)>;

  static kernel::outcome::Result<std::unique_ptr<Clock>> make(
      const kernel::machine::Machine& machine, Told told);
  /// With known times: nothing is planned. finish() refuses a requested line that is not known.
  /// `known` must outlive the clock.
  static std::unique_ptr<Clock> of(const KnownTimes& known, Told told);
  /// One of the two.
  static kernel::outcome::Result<std::unique_ptr<Clock>> make(
      const KnownTimes* known, const kernel::machine::Machine& machine, Told told) {
    return known != nullptr ? of(*known, std::move(told)) : make(machine, std::move(told));
  }

  /// Asks for the time of the line that is fed next.
  void ask(std::uint64_t ticket) {
    asked_.push_back({.sequence = sequence_ + 1, .ticket = ticket});
  }
  /// Feeds the moves and events of the walk's current line. Overwrites their line numbers.
  void feed(Walk& walk);
  /// The program's total time; reports every requested line before it returns.
  [[nodiscard]] kernel::outcome::Result<double> finish();

 private:
  struct Asked {
    std::uint32_t sequence;
    std::uint64_t ticket;
  };
  explicit Clock(Told told) : told_(std::move(told)) {}
  void tell(const Walk& walk);
  void arrived(std::uint32_t sequence, double time_s);

  std::optional<plan::SegmentTimer> timer_;
  const KnownTimes* known_ = nullptr;
  std::uint32_t unknown_line_ = 0;
  Told told_;
  std::deque<Asked> asked_;
  std::uint32_t sequence_ = 0;  ///< replaces the line number, which need not grow
};

}  // namespace steadyrest::nc::rewrite
