// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/prove/plan_match.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>
#include <steadyrest/nc/rewrite/walk/clock.hpp>

namespace steadyrest::nc::rewrite {

/// Whether corrections act within the window about their planned instants.
class Window {
 public:
  /// `changed` names the file in refusals. All arguments must outlive it.
  static kernel::outcome::Result<std::unique_ptr<Window>> make(
      const KnownTimes* known, const kernel::machine::Machine& machine, const Plan& plan,
      const Settings& settings, const std::string& changed);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() = default;

  /// The correction of an axis of the plan changes in the line that is fed next.
  void ask(std::size_t axis, const WrittenChange& change);
  void feed(Walk& walk) { clock_->feed(walk); }
  /// The program's time. Refused: a time other than the plan's, changes that are not the plan's.
  [[nodiscard]] kernel::outcome::Result<double> finish();

 private:
  Window(const Plan& plan, const Settings& settings, const std::string& changed)
      : plan_(plan), settings_(settings), changed_(changed), changes_(plan.axes.size()) {}

  const Plan& plan_;
  const Settings& settings_;
  const std::string& changed_;
  std::unique_ptr<Clock> clock_;
  std::vector<std::vector<WrittenChange>> changes_;  ///< by axis of the plan
};

}  // namespace steadyrest::nc::rewrite
