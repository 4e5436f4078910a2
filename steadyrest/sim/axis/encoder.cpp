// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>

#include <steadyrest/sim/axis/encoder.hpp>
#include <steadyrest/sim/base/portable.hpp>
#include <steadyrest/sim/base/range.hpp>

namespace steadyrest::sim {

Encoder::Encoder(const Config& config) noexcept
    : count_mm_(config.count_au),
      counts_1_mm_(config.count_au > 0.0 ? 1.0 / config.count_au : 0.0),
      line_error_mm_(config.line_error_au),
      lines_1_mm_(config.line_error_au > 0.0 ? 1.0 / config.line_period_au : 0.0) {}

kernel::outcome::Result<Encoder> Encoder::make(const Config& config) {
  constexpr double kMax = 1e3;
  const bool has_lines = config.line_error_au > 0.0;
  if (auto ok = in_range("encoder",
                         {{"count_mm", config.count_au, 0.0, kMax},
                          {"line_error_mm", config.line_error_au, 0.0, kMax},
                          {"line_period_mm", has_lines ? config.line_period_au : 1.0, 1e-9, kMax},
                          {"clock_s", config.clock_s, 0.0, 1.0}});
      !ok) {
    return std::unexpected(ok.error());
  }
  return Encoder(config);
}

// One sine per signal period: the short-period error left by interpolation of a real scale.
double Encoder::reading(double position_mm) const noexcept {
  return line_error_mm_ > 0.0
             ? position_mm + line_error_mm_ * portable::sin_turn(position_mm * lines_1_mm_)
             : position_mm;
}

// Rounded, not truncated: count n is shown from n − ½ to n + ½.
double Encoder::read(double position_mm) const noexcept {
  const double seen_mm = reading(position_mm);
  return count_mm_ > 0.0 ? std::floor(seen_mm * counts_1_mm_ + 0.5) * count_mm_ : seen_mm;
}

std::int64_t Encoder::count(double position_mm) const noexcept {
  return static_cast<std::int64_t>(std::floor(reading(position_mm) * counts_1_mm_ + 0.5));
}

}  // namespace steadyrest::sim
