// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/edges/edge_event.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::motion::online {

/// Turns the recorder's integers into edges and ticks for the estimators.
///
///   t = (ticks − ticks₀)/f,   x(k) = k·q + ε(k)
/// with the clock f, the count q, the error ε of line k from the calibration table, and ticks₀ the
/// first time received, so that a clock of ns since 1970 keeps its resolution (f·t < 2⁵³).
///
/// An event whose time is unknown or whose line is a guess gives no edge: the next good one reports
/// the missing edges, and the tick's cell is valid meanwhile.
class EdgeStream {
 public:
  struct Config {
    double count_mm = 0.001;  ///< q > 0
    double clock_hz = 1e7;    ///< f > 0
    /// ε of the lines first_line, first_line + 1 …; empty: none. Must outlive the stream.
    /// The empty braces are for g++'s -Wmissing-field-initializers.
    std::span<const double> line_error_mm = {};  // NOLINT(readability-redundant-member-init)
    std::int64_t first_line = 0;
    bool periodic = false;      ///< the table is one revolution and repeats; else ε = 0 beyond it
    bool take_guesses = false;  ///< also edges of guessed lines; bounds then no longer hold
  };

  static kernel::outcome::Result<EdgeStream> make(const Config& config);

  /// The edge, or none where the event is unfit.
  std::optional<Edge> edge(const EdgeEvent& event) noexcept;
  /// The control cycle's tick: unwrapped clock and count of the decoder.
  Tick tick(std::uint64_t ticks, std::int64_t count) noexcept;

  [[nodiscard]] double line_mm(std::int64_t line) const noexcept;

 private:
  explicit EdgeStream(const Config& config) noexcept : config_(config) {}
  double seconds(std::uint64_t ticks) noexcept;

  Config config_;
  bool started_ = false;
  std::uint64_t zero_ticks_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace steadyrest::motion::online
