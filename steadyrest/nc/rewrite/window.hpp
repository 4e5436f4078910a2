// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/rewrite/clock.hpp>
#include <steadyrest/nc/rewrite/plan_file.hpp>
#include <steadyrest/nc/rewrite/settings.hpp>

namespace steadyrest::nc::rewrite {

/// Whether corrections act within the window about the instants that they are planned at.
class Window {
 public:
  /// `changed` names the file in refusals. What is given stays where it is.
  static kernel::outcome::Result<std::unique_ptr<Window>> make(
      const KnownTimes* known, const kernel::machine::Machine& machine, const Plan& plan,
      const Settings& settings, const std::string& changed);
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() = default;

  /// The steps `from` … `to` of an axis act in the line that is fed next, `line` of the changed
  /// program.
  void ask(const AxisPlan& axis, std::size_t from, std::size_t to, std::uint32_t line);
  void feed(Walk& walk) { clock_->feed(walk); }
  /// The program's time. Refused: another time than the plan's, a step beyond its window.
  [[nodiscard]] kernel::outcome::Result<double> finish();

 private:
  struct Asked {
    const AxisPlan* axis;
    std::size_t to;
    std::uint32_t line;
  };
  Window(const Plan& plan, const Settings& settings, const std::string& changed)
      : plan_(plan), settings_(settings), changed_(changed) {}
  void told(std::uint64_t from, double time_s);

  const Plan& plan_;
  const Settings& settings_;
  const std::string& changed_;
  std::unique_ptr<Clock> clock_;
  std::deque<Asked> asked_;
  std::optional<kernel::outcome::Refusal> too_far_;
};

}  // namespace steadyrest::nc::rewrite
