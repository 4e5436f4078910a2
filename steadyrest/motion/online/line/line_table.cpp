// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

namespace steadyrest::motion::online {
namespace {

using kernel::outcome::refuse;

// Which test fails when one is changed: README, "What the constants do".
constexpr double kPhaseLearn =
    0.02;  ///< of a residual, per edge: each phase is seen a quarter of the time
/// Share of an error that is forgotten when it is relearnt. A fit is slightly wrong in the same way
/// each time the axis repeats a motion; errors common to neighbours are not seen, so without
/// forgetting they would add up without end.
constexpr double kForget = 0.02;
constexpr double kWorth = 0.003;  ///< RMS in counts: below this the table is no better than none
constexpr double kUnseen =
    0.2;  ///< share of the lines' error common to neighbours, which is not learnt
constexpr int kKnownAfter = 6;  ///< passages

// Four lines to a signal period. & 3 is right for negative lines too, where % would not be.
std::size_t phase_of(std::int64_t line) noexcept {
  return static_cast<std::size_t>(line & 3);
}

}  // namespace

kernel::outcome::Result<LineTable> LineTable::make(const Config& config) {
  if (!(config.count_mm > 0.0) || !std::isfinite(config.count_mm)) {
    return refuse("the length of a count is not positive", "give the length of one count in mm");
  }
  if (config.lines > kMaxLines) {
    return refuse("the table has more than 1 048 576 lines",
                  "calibrate a shorter range, or one revolution");
  }
  if (config.periodic && (config.lines % 4 != 0 || config.lines == 0)) {
    return refuse("a revolution is not a multiple of four counts",
                  "give four times the encoder's lines per revolution");
  }
  if (!(config.learn >= 0.0 && config.learn <= 1.0) || !(config.max_span_s > 0.0) ||
      !(config.max_rms_counts > 0.0)) {
    return refuse("the learning rate is outside 0 … 1, or a limit is not positive",
                  "use the defaults");
  }
  return LineTable(config);
}

LineTable::LineTable(const Config& config)
    : config_(config),
      fit_(config.max_span_s),
      error_mm_(config.lines, 0.0),
      visits_(config.lines, 0) {}

std::ptrdiff_t LineTable::index(std::int64_t line) const noexcept {
  const auto n = static_cast<std::int64_t>(error_mm_.size());
  if (n == 0) {
    return -1;
  }
  std::int64_t i = line - config_.first_line;
  if (config_.periodic) {
    i %= n;
    // The sign of % follows the dividend.
    i += i < 0 ? n : 0;
  }
  return i >= 0 && i < n ? static_cast<std::ptrdiff_t>(i) : -1;
}

double LineTable::correction_mm(std::int64_t line) const noexcept {
  const std::ptrdiff_t i = index(line);
  return phase_mm_[phase_of(line)] + (i >= 0 ? error_mm_[static_cast<std::size_t>(i)] : 0.0);
}

double LineTable::position_mm(std::int64_t line) const noexcept {
  return static_cast<double>(line) * config_.count_mm + (worth_ ? correction_mm(line) : 0.0);
}

bool LineTable::learnt(std::int64_t line) const noexcept {
  const std::ptrdiff_t i = index(line);
  return i >= 0 && visits_[static_cast<std::size_t>(i)] >= kKnownAfter;
}

float LineTable::sigma_mm(std::int64_t line) const noexcept {
  return worth_ ? static_cast<float>(std::sqrt(spread2_mm2_) * (learnt(line) ? kUnseen : 1.0))
                : -1.0F;
}

void LineTable::learn(double t_s, std::int64_t line, std::int8_t direction, bool lost) noexcept {
  if (fit_.breaks(t_s, line, direction, lost)) {
    // Lines near the end of a run would never be the middle of a full window; shorter windows reach
    // them.
    for (std::size_t half = fit_.longest_tail(); half >= LineFit::kLeast; --half) {
      take(fit_.tail(half));
    }
    fit_.clear();
  }
  // The corrected position goes in: only the remainder is learnt.
  take(fit_.push(t_s, static_cast<double>(line) * config_.count_mm + correction_mm(line), line,
                 direction));
}

void LineTable::take(const LineFit::Residual& r) noexcept {
  if (!r.valid || r.rms_mm > config_.max_rms_counts * config_.count_mm) {
    return;
  }
  ++fits_;
  residual2_mm2_ += 0.01 * (r.rms_mm * r.rms_mm - residual2_mm2_);
  if (config_.learn <= 0.0) {
    return;
  }
  const std::ptrdiff_t i = index(r.line);
  if (i >= 0) {
    const auto k = static_cast<std::size_t>(i);
    error_mm_[k] += config_.learn * (r.error_mm - kForget * error_mm_[k]);
    visits_[k] = static_cast<std::uint8_t>(std::min<int>(visits_[k] + 1, 255));
    spread2_mm2_ += 0.002 * (error_mm_[k] * error_mm_[k] - spread2_mm2_);
  }
  phase_mm_[phase_of(r.line)] += kPhaseLearn * r.error_mm;
  const double mean = 0.25 * (phase_mm_[0] + phase_mm_[1] + phase_mm_[2] + phase_mm_[3]);
  for (double& p : phase_mm_) {
    p -= mean;  // the part common to all four is a shift of the scale
  }
  weigh();
}

void LineTable::weigh() noexcept {
  double phase2 = 0.0;
  for (const double p : phase_mm_) {
    phase2 += 0.25 * p * p;
  }
  const double least = kWorth * config_.count_mm;
  worth_ = std::max(phase2, spread2_mm2_) > least * least;
}

void LineTable::restore(const std::array<double, 4>& phase_mm, std::span<const double> error_mm) {
  phase_mm_ = phase_mm;
  std::ranges::fill(error_mm_, 0.0);
  std::ranges::fill(visits_, std::uint8_t{0});
  std::copy_n(error_mm.begin(), std::min(error_mm.size(), error_mm_.size()), error_mm_.begin());
  double sum2 = 0.0;
  double known = 0.0;
  for (std::size_t i = 0; i < error_mm_.size(); ++i) {
    if (error_mm_[i] != 0.0) {
      visits_[i] = 255;
      sum2 += error_mm_[i] * error_mm_[i];
      known += 1.0;
    }
  }
  spread2_mm2_ = known > 0.0 ? sum2 / known : 0.0;
  weigh();
}

void LineTable::settle() noexcept {
  std::array<double, 4> sum{};
  std::array<double, 4> n{};
  for (std::size_t i = 0; i < error_mm_.size(); ++i) {
    const std::size_t phase = phase_of(config_.first_line + static_cast<std::int64_t>(i));
    if (visits_[i] > 0) {
      sum[phase] += error_mm_[i];
      n[phase] += 1.0;
    }
  }
  for (std::size_t p = 0; p < 4; ++p) {
    // A phase never seen has no mean; then nothing can be moved without shifting the scale.
    if (n[p] <= 0.0) {
      return;
    }
    sum[p] /= n[p];
  }
  // Each phase's mean moves from the lines to the phase, except the part common to all four, which
  // is scale.
  const double common = 0.25 * (sum[0] + sum[1] + sum[2] + sum[3]);
  for (std::size_t i = 0; i < error_mm_.size(); ++i) {
    const std::size_t phase = phase_of(config_.first_line + static_cast<std::int64_t>(i));
    error_mm_[i] -= visits_[i] > 0 ? sum[phase] : 0.0;
  }
  for (std::size_t p = 0; p < 4; ++p) {
    phase_mm_[p] += sum[p] - common;
  }
  weigh();
}

double LineTable::residual_mm() const noexcept {
  return std::sqrt(residual2_mm2_);
}

}  // namespace steadyrest::motion::online
