// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/outcome/reason.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/signal/request.hpp>

namespace steadyrest::chatter::online {

/// The better spindle speed for a chattering cut, from the planner's earlier results.
///
/// Law. With a table (speed → limiting depth, straight lines between): the permitted override step
/// with the largest limiting depth, or the one nearest to the present step when several allow the
/// depth of cut with `reserve` to spare; only a step that allows more than the present one counts.
/// Without a table the classical rule: n = 60·fc/(N·k), k = 1, 2 … (Smith, Tlusty; Okuma, MAL),
/// whole waves of the chatter between two teeth; the nearest permitted step within 2.5 % of such a
/// speed and a tenth of a wave. Permitted: within the ratios and the spindle's limits, and not the
/// present step. Outside the table's speeds the limit is 0. O(steps·log speeds), no allocation.
class SpeedTable {
 public:
  struct Config {
    std::vector<double> speed_rev_s;     ///< > 0, rising; empty: the classical rule alone
    std::vector<double> limit_depth_mm;  ///< ≥ 0, as many
    std::vector<double> step_ratio;      ///< of the spindle override, ≥ 0, not falling; 1 … 256
    std::size_t teeth = 2;               ///< 1 … 64
    double min_ratio = 0.5;              ///< 0 … 1
    double max_ratio = 1.2;              ///< ≥ min_ratio
    double min_rev_s = 0.0;              ///< of the spindle, ≥ 0
    double max_rev_s = 1e3;              ///< > min_rev_s
    double reserve = 1.1;                ///< limit over depth that counts as plenty, ≥ 1
  };

  struct Question {
    double programmed_rev_s = 0.0;  ///< speed at ratio 1, > 0
    double ratio = 1.0;             ///< in force
    double depth_mm = 0.0;          ///< of the cut; 0 = not known: the deepest step
    double frequency_hz = 0.0;      ///< of the chatter; for the rule
  };

  struct Advice {
    kernel::signal::SpindleRequest request;  ///< neutral when nothing is better
    kernel::outcome::Reason reason = kernel::outcome::Reason::chatter_no_better_speed;
    double speed_rev_s = 0.0;     ///< asked for; 0 = none
    double limit_depth_mm = 0.0;  ///< there; 0 = not known
    unsigned waves = 0;           ///< k of the rule; 0 = from the table
  };

  /// Refuses arrays of different length and values that do not rise or are out of range.
  [[nodiscard]] static kernel::outcome::Result<SpeedTable> make(Config config);

  /// Unfit numbers give the neutral request with input_not_finite or input_out_of_range.
  [[nodiscard]] Advice ask(const Question& question) const noexcept;
  /// Limiting depth at the speed in mm; 0 outside the table.
  [[nodiscard]] double limit_depth_mm(double speed_rev_s) const noexcept;

 private:
  explicit SpeedTable(Config config) : config_(std::move(config)) {}
  [[nodiscard]] bool permitted(double ratio, double speed_rev_s) const noexcept;
  [[nodiscard]] Advice from_table(const Question& question) const noexcept;
  [[nodiscard]] Advice from_rule(const Question& question) const noexcept;

  Config config_;
};

}  // namespace steadyrest::chatter::online
