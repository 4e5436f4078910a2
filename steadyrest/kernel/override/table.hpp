// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::override {

/// Two ratios closer than this are the same: rounding in a percent conversion must not cost a step.
inline constexpr double kRatioTolerance = 1e-9;

/// The override switch of one machine: step ↔ ratio ↔ code.
///
/// Machine data, never a constant: on one 840D the code 11010 means 100 %, on another 70 %. A code
/// that is not in the table is unknown; it is never rounded to a neighbour. Ratios are the
/// effective ones: the control clips them at `max_ratio`. Steps of equal ratio are allowed (unused
/// positions repeat the last value) and count as one: a search by ratio gives the lowest of them,
/// and the way up or down from any of them leads to the next different ratio.
/// All queries are noexcept, allocate nothing and take O(log steps).
class Table {
 public:
  using Config = machine::OverrideTable;

  /// Refuses: no steps, ratios that are not finite, negative or decreasing, codes that are repeated
  /// or not as many as the ratios, Gray neighbours that differ in more than one bit, times that are
  /// negative or not finite. Without codes a Gray table gets `sinumerik_code(step)`; a binary one
  /// must bring its own.
  [[nodiscard]] static outcome::Result<Table> make(const Config& config);

  [[nodiscard]] std::size_t steps() const noexcept { return ratio_.size(); }
  /// step < steps().
  [[nodiscard]] double ratio(std::size_t step) const noexcept;
  [[nodiscard]] std::uint32_t code(std::size_t step) const noexcept;
  [[nodiscard]] std::span<const double> ratios() const noexcept { return ratio_; }
  [[nodiscard]] std::span<const std::uint32_t> codes() const noexcept { return code_; }

  /// The step with this code; empty for a code that is not in the table.
  [[nodiscard]] std::optional<std::size_t> step_of_code(std::uint32_t code) const noexcept;
  /// The step of the largest ratio not above `ratio`; empty when all are above it or `ratio` is
  /// NaN.
  [[nodiscard]] std::optional<std::size_t> floor_step(double ratio) const noexcept;
  /// The step of the smallest ratio not below `ratio`; empty when all are below it or `ratio` is
  /// NaN.
  [[nodiscard]] std::optional<std::size_t> ceil_step(double ratio) const noexcept;
  /// The step whose ratio is nearest, the lower one of two equally near; empty for NaN.
  [[nodiscard]] std::optional<std::size_t> nearest_step(double ratio) const noexcept;

  /// Steps of equal ratio, as a closed range.
  struct Run {
    std::size_t first = 0;
    std::size_t last = 0;
  };
  /// All steps with the ratio of this one.
  [[nodiscard]] Run equal_steps(std::size_t step) const noexcept;

  [[nodiscard]] double min_ratio() const noexcept { return ratio_.front(); }
  [[nodiscard]] double max_ratio() const noexcept { return ratio_.back(); }

  [[nodiscard]] machine::Coding coding() const noexcept { return coding_; }
  [[nodiscard]] double scan_period_s() const noexcept { return scan_period_s_; }
  [[nodiscard]] double dead_time_s() const noexcept { return dead_time_s_; }
  [[nodiscard]] bool latched_word() const noexcept { return latched_word_; }
  [[nodiscard]] bool layer_may_exceed_panel() const noexcept { return layer_may_exceed_panel_; }

 private:
  struct CodeEntry {
    std::uint32_t code;
    std::uint32_t step;
  };

  Table() = default;

  std::vector<double> ratio_;
  std::vector<std::uint32_t> code_;
  std::vector<CodeEntry> by_code_;  ///< sorted by code
  machine::Coding coding_ = machine::Coding::gray;
  double scan_period_s_ = 0.0;
  double dead_time_s_ = 0.0;
  bool latched_word_ = true;
  bool layer_may_exceed_panel_ = false;
};

}  // namespace steadyrest::kernel::override
