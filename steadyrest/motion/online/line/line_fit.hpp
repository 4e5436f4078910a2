// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

/// How far one line of the encoder is from where its neighbours say it should be: no reference is
/// needed, only motion that is smooth over a few dozen lines.
///
/// A cubic x(t) is fitted by least squares through 2m + 1 passages in one direction, at the times
/// tᵢ; the middle line's error is fit(t) − x, since the axis was there when it passed the line. m
/// is kHalf, or less, down to kLeast, at the ends of a motion in one direction. Errors common to
/// more than the window are not seen, but do no harm: they are a slow scale error. Principle:
/// Boggarpu, Kavanagh, IEEE TIM 2010 (learning the lines in place).
namespace steadyrest::motion::online {

class LineFit {
 public:
  static constexpr std::size_t kHalf = 24;  ///< m
  static constexpr std::size_t kLeast = 6;
  static constexpr std::size_t kWindow = 2 * kHalf + 1;

  struct Residual {
    std::int64_t line = 0;
    double error_mm = 0.0;  ///< to be added to the position given for the line
    double rms_mm = 0.0;    ///< of all residuals in the window
    bool valid = false;
  };

  /// `max_span_s`: a window that took longer is not used, since the motion is not smooth enough.
  explicit LineFit(double max_span_s = 0.02) noexcept : max_span_s_(max_span_s) {}

  /// A passage, in time order; a turn or a lost edge starts a new window. Valid once the window is
  /// full.
  Residual push(double t_s, double position_mm, std::int64_t line, std::int8_t direction) noexcept;
  /// Whether a passage would start a new window; then the windows at the end of the old passages
  /// are `tail(longest_tail())` … `tail(kLeast)`.
  [[nodiscard]] bool breaks(double t_s, std::int64_t line, std::int8_t direction,
                            bool lost) const noexcept;
  [[nodiscard]] std::size_t longest_tail() const noexcept {
    return count_ < 2 ? 0 : (count_ - 2) / 2;  // the last `push` had one more
  }
  [[nodiscard]] Residual tail(std::size_t half) const noexcept;
  void clear() noexcept { count_ = 0; }

 private:
  /// Every passage is stored in both halves of the rings, so that any window is contiguous.
  void put(double t_s, double position_mm) noexcept;

  double max_span_s_;
  std::array<double, 2 * kWindow> t_s_{};
  std::array<double, 2 * kWindow> position_mm_{};
  std::int64_t line_ = 0;  ///< the last one passed
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::int8_t direction_ = 0;
};

}  // namespace steadyrest::motion::online
