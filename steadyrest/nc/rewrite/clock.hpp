// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/plan/segment_timer.hpp>
#include <steadyrest/nc/rewrite/walk.hpp>

namespace steadyrest::nc::rewrite {

/// When the machine gets to the lines of a walk: the times of segment_timer, asked for at chosen
/// lines only, so that memory does not grow with the program.
class Clock {
 public:
  /// Told of a chosen line, in the order of the lines: when its first move begins.
  using Told = std::function<void(std::uint64_t ticket, double time_s)>;

  static kernel::outcome::Result<std::unique_ptr<Clock>> make(
      const kernel::machine::Machine& machine, Told told);

  /// Asks for the time of the line that is fed next.
  void ask(std::uint64_t ticket) {
    asked_.push_back({.sequence = sequence_ + 1, .ticket = ticket});
  }
  /// The moves and events of the line that the walk has been at.
  void feed(const Walk& walk);
  /// The program's total time; every line that was asked for is told before it returns.
  [[nodiscard]] kernel::outcome::Result<double> finish();

 private:
  struct Asked {
    std::uint32_t sequence;
    std::uint64_t ticket;
  };
  Clock(plan::SegmentTimer timer, Told told) : timer_(std::move(timer)), told_(std::move(told)) {}
  void arrived(std::uint32_t sequence, double time_s);

  plan::SegmentTimer timer_;
  Told told_;
  std::deque<Asked> asked_;
  std::uint32_t sequence_ = 0;  ///< stands in for the line, which need not grow
};

}  // namespace steadyrest::nc::rewrite
