// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace steadyrest::chatter::online {

/// The least and the greatest ratio recently sent to the control that may still be on their way to
/// the machine: each counts for one to two spans. Plain values, two halves instead of a list.
struct RecentWords {
  struct Half {
    double least = std::numeric_limits<double>::infinity();
    double most = 0.0;
  };
  Half now;
  Half before;
  Half last;            ///< the previous word, held until now
  double ends_s = 0.0;  ///< of the current half

  /// `span_s` ≥ 0 and the same each time. A time that went back ends the half.
  void note(double time_s, double span_s, double ratio) noexcept {
    if (!(time_s < ends_s) || time_s < ends_s - span_s) {
      before = std::abs(time_s - ends_s) < span_s ? now : Half{};
      now = {};
      ends_s = time_s + span_s;
    }
    now.least = std::min({now.least, last.least, ratio});
    now.most = std::max({now.most, last.most, ratio});
    last = {.least = ratio, .most = ratio};
  }
  /// Infinity when nothing was sent.
  [[nodiscard]] double least() const noexcept { return std::min(now.least, before.least); }
  /// 0 when nothing was sent.
  [[nodiscard]] double most() const noexcept { return std::max(now.most, before.most); }
  [[nodiscard]] bool fit() const noexcept {
    return std::isfinite(ends_s) && now.least >= 0.0 && before.least >= 0.0 && last.least >= 0.0 &&
           std::isfinite(last.most) && std::isfinite(now.most) && std::isfinite(before.most);
  }
};

}  // namespace steadyrest::chatter::online
