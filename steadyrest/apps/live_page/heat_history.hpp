// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <mutex>

#include <steadyrest/apps/live_page/desk.hpp>

namespace steadyrest::apps::live_page {

/// What heat has done to the axes and what was done against it, every ten seconds of the last
/// twelve hours. update() from one thread, the rest from any.
class HeatHistory {
 public:
  explicit HeatHistory(const Desk& desk) : desk_(desk) {}

  void update(double now_s);
  /// `share_k`, `passports`, `history`, `next` (null: nothing is planned), `readings`.
  [[nodiscard]] web::Response show() const;

 private:
  struct Entry {
    double time_s = 0.0;
    steadyrest::live::LiveStatus status;
  };

  const Desk& desk_;
  double next_s_ = 0.0;
  mutable std::mutex mutex_;
  std::deque<Entry> entries_;
};

}  // namespace steadyrest::apps::live_page
