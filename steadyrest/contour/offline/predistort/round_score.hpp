// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>

#include <steadyrest/contour/offline/predict/error_figures.hpp>
#include <steadyrest/contour/offline/predistort/run_errors.hpp>

namespace steadyrest::contour::offline {

/// What a program that may take longer would reach.
struct Slower {
  double seconds = 0.0;
  double rms_mm = 0.0;
  double max_mm = 0.0;
};

/// How good a round is beside the program as it is, and whether it may take its time.
class RoundScore {
 public:
  /// `most_time`: of the program's own.
  RoundScore(double most_time, double seconds_before, const ErrorFigures::Of& before,
             double limit_mm)
      : limit_mm_(limit_mm),
        before_s_(seconds_before),
        most_s_(most_time * seconds_before),
        refined_s_((most_time > kUsualTime ? most_time : kRefinedTime) * seconds_before),
        slowest_s_(2.0 * seconds_before),
        before_rms_mm_(before.rms_mm()),
        most_mm_(kLargestGrows * before.max_mm) {}

  /// The lower, the better. Any round that leaves the largest error alone is better than one that
  /// does not. `blocks`: of the text, for each one of the original; the control must read them.
  [[nodiscard]] double of_mm(const ErrorFigures::Of& round, double blocks,
                             double seconds) const noexcept {
    return round.rms_mm() + kShareOfLargest * round.max_mm +
           limit_mm_ * std::clamp(kBlock * (blocks - 1.0), 0.0, kMostForBlocks) +
           limit_mm_ * std::clamp(kTime * (seconds / before_s_ - 1.0), 0.0, kMostForTime) +
           (round.max_mm > most_mm_ ? before_rms_mm_ : 0.0);
  }
  /// In terms of what is permitted.
  [[nodiscard]] double time(double seconds, bool refined) const noexcept {
    return seconds / (refined ? refined_s_ : most_s_);
  }
  [[nodiscard]] bool in_time(double seconds, bool refined) const noexcept {
    return time(seconds, refined) <= 1.0;
  }
  /// Keeps in mind the best round that takes longer than is permitted, up to twice the program's
  /// time.
  void note_slower(double seconds, const ErrorFigures::Of& round) {
    if (seconds > most_s_ && seconds <= slowest_s_ && round.max_mm <= most_mm_ &&
        (!slower_ || round.rms_mm() < slower_->rms_mm)) {
      slower_ = {.seconds = seconds, .rms_mm = round.rms_mm(), .max_mm = round.max_mm};
    }
  }
  /// None where time would not win much against `after`.
  [[nodiscard]] std::optional<Slower> slower(const ErrorFigures::Of& after) const {
    constexpr double kMuch = 0.7;
    return slower_ && slower_->rms_mm < kMuch * after.rms_mm() ? slower_ : std::nullopt;
  }

  static constexpr double kUsualTime = 1.02;

 private:
  static constexpr double kRefinedTime = 1.005;
  static constexpr double kShareOfLargest = 0.05;
  static constexpr double kBlock = 0.02;          ///< of the limit, for each …
  static constexpr double kMostForBlocks = 0.05;  ///< … and for all
  static constexpr double kTime = 5.0;            ///< of the limit, for the program's time …
  static constexpr double kMostForTime = 0.05;    ///< … and at most

  double limit_mm_;
  double before_s_;
  double most_s_;
  double refined_s_;
  double slowest_s_;
  double before_rms_mm_;
  double most_mm_;
  std::optional<Slower> slower_;
};

}  // namespace steadyrest::contour::offline
