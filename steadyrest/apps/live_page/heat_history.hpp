// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <mutex>
#include <vector>

#include <steadyrest/apps/live_page/desk.hpp>
#include <steadyrest/apps/live_page/heat/corrections.hpp>
#include <steadyrest/apps/live_page/heat/outlook.hpp>

namespace steadyrest::apps::live_page {

/// What heat has done to the axes, what drove it and what was done against it, every ten seconds of
/// the last twelve hours; and what comes in the next hour. update() from one thread, the rest from
/// any.
class HeatHistory {
 public:
  explicit HeatHistory(const Desk& desk) : desk_(desk) {}

  /// Some 30 times a second.
  void update(double now_s);
  /// A measured size that somebody has entered: `axis`, `displacement_um`, and its verdict. The
  /// newest fifty are kept.
  void add_reading(Json reading);
  /// `share_k`, `passports`, `history`, `cyclogram`, `outlook`, `corrections`, `next`, `readings`,
  /// and switched_off_json().
  [[nodiscard]] web::Response show() const;

 private:
  struct Entry {
    double time_s = 0.0;
    std::array<double, kernel::signal::kMaxAxes> displacement_mm{};
    std::array<double, kernel::signal::kMaxAxes> sd_mm{};
    kernel::signal::AxisValues offset_mm{};
    thermal::online::OffsetGovernor::Fed fed;
  };
  /// A copy of what the answer is made from.
  struct Seen {
    std::vector<Entry> entries;  ///< as many as a plot shows
    std::vector<Stretch> lately;
    Corrections corrections;
    steadyrest::live::HeatNow now;
    bool corrects = false;
    Json readings;
  };

  void note(double now_s, const steadyrest::live::LiveStatus& status);
  [[nodiscard]] Seen seen() const;
  [[nodiscard]] static Stretch between(const Entry& from, const Entry& to);
  [[nodiscard]] static Json history_json(const std::vector<Entry>& entries,
                                         const kernel::machine::Machine& machine);
  [[nodiscard]] static Json cyclogram_json(const std::vector<Entry>& entries);

  const Desk& desk_;
  double next_s_ = 0.0;
  mutable std::mutex mutex_;
  std::deque<Entry> entries_;
  Corrections corrections_;
  steadyrest::live::HeatNow now_;
  bool corrects_ = false;
  std::deque<Json> readings_;
};

}  // namespace steadyrest::apps::live_page
