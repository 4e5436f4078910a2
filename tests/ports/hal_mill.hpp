// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <tests/ports/subject.hpp>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>

namespace steadyrest::ports {

/// LinuxCNC's side of the HAL pins with layer.hal loaded: cuts along X, one servo cycle of 1 ms for
/// each row that is asked for. Watchdog, hold, ceiling of the feed, ramp and adaptive feed as in
/// layer.hal.
class HalMill final : public adapters::linuxcnc::HalSide {
 public:
  static constexpr double kPeriod_s = 0.001;

  HalMill(std::vector<Turn> turns, bool offsets)
      : turns_(std::move(turns)), with_offsets_(offsets) {}

  bool read_row(std::size_t channel, adapters::linuxcnc::Row& row) noexcept override {
    if (lost) {
      return false;
    }
    if (channel == 0) {
      step();
    }
    row = channel == 0 ? state_row() : axis_row();
    return true;
  }
  [[nodiscard]] std::size_t waiting(std::size_t /*channel*/) const noexcept override { return 0; }
  void write_pins(const adapters::linuxcnc::Pins& pins) noexcept override {
    unheard_ = pins.heartbeat == pins_.heartbeat ? unheard_ : 0;
    heard_ = heard_ || unheard_ == 0;
    alive_ = alive_ || (pins.armed && !pins_.armed);
    pins_ = pins;
  }
  adapters::linuxcnc::Inputs read_inputs() noexcept override { return {}; }
  [[nodiscard]] bool offsets_connected() const noexcept override { return with_offsets_; }
  [[nodiscard]] kernel::signal::AxisValues offset_in_force() const noexcept override {
    return offset_mm_;
  }
  [[nodiscard]] kernel::signal::AxisValues offset_acceleration() const noexcept override {
    return {};
  }
  void pause() noexcept override {}

  bool lost = false;

 private:
  static constexpr double kFeed_mm_s = 20.0;
  static constexpr int kWatchdog = 20;      ///< cycles
  static constexpr int kHold = 1000;        ///< cycles
  static constexpr double kRise = 0.015;    ///< a cycle, of a layer that lives
  static constexpr double kReturn = 0.002;  ///< a cycle, after a late or dead one
  static constexpr double kNoCeiling = 10.0;
  static constexpr double kOffsetStep = 0.002;  ///< mm a cycle

  void step() noexcept {
    ++tick_;
    for (const Turn& turn : turns_) {
      panel_ = turn.time_s <= static_cast<double>(tick_) * kPeriod_s ? turn.ratio : panel_;
    }
    alive_ = ++unheard_ <= kWatchdog && alive_ && pins_.armed;
    const bool held = heard_ && unheard_ <= kHold;
    const double rate = alive_ ? kRise : kReturn;
    ceiling_ = std::min(held ? pins_.feed : kNoCeiling, ceiling_ + rate);
    feed_ = std::min(1.0, ceiling_ / (panel_ > 0.0 ? panel_ : 1.0));
    spindle_ += std::clamp((held ? pins_.spindle : 1.0) - spindle_, -rate, rate);
    x_mm_ += kFeed_mm_s * panel_ * feed_ * kPeriod_s;
    for (std::size_t i = 0; i < offset_mm_.size(); ++i) {
      const double goal_mm = pins_.offset[i] + (alive_ ? pins_.path_offset[i] : 0.0);
      offset_mm_[i] += std::clamp(goal_mm - offset_mm_[i], -kOffsetStep, kOffsetStep);
    }
  }
  [[nodiscard]] adapters::linuxcnc::Row state_row() const noexcept {
    const double speed = kFeed_mm_s * panel_ * feed_;
    return {static_cast<double>(tick_),
            2.0,
            5.0,
            speed,
            kFeed_mm_s,
            speed,
            50.0,
            50.0 * spindle_,
            1.0,
            panel_,
            1.0,
            1.0,
            feed_,
            spindle_,
            alive_ ? 1.0 : 0.0,
            1.0,
            1.0};
  }
  [[nodiscard]] adapters::linuxcnc::Row axis_row() const noexcept {
    adapters::linuxcnc::Row row{static_cast<double>(tick_)};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t first = 1 + adapters::linuxcnc::kAxisColumns * i;
      row[first] = row[first + 1] = (i == 0 ? x_mm_ : 0.0) + offset_mm_[i];
      row[first + 3] = offset_mm_[i];
    }
    return row;
  }

  std::vector<Turn> turns_;
  bool with_offsets_;
  adapters::linuxcnc::Pins pins_;
  kernel::signal::AxisValues offset_mm_{};
  std::uint64_t tick_ = 0;
  double panel_ = 1.0;
  double ceiling_ = kNoCeiling;  ///< of the feed, on top of the panel
  double feed_ = 1.0;
  double spindle_ = 1.0;
  double x_mm_ = 0.0;
  int unheard_ = 0;
  bool heard_ = false;
  bool alive_ = false;
};

}  // namespace steadyrest::ports
