// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <steadyrest/adapters/linuxcnc/hal_side.hpp>

namespace steadyrest::adapters::linuxcnc::test {

/// A HAL whose rows the test writes.
class FakeHal final : public HalSide {
 public:
  FakeHal() { written.reserve(1000); }

  bool read_row(std::size_t channel, Row& row) noexcept override {
    if (next[channel] == rows[channel].size()) {
      return false;
    }
    row = rows[channel][next[channel]++];
    return true;
  }
  [[nodiscard]] std::size_t waiting(std::size_t channel) const noexcept override {
    return rows[channel].size() - next[channel];
  }
  void write_pins(const Pins& pins) noexcept override { written.push_back(pins); }
  Inputs read_inputs() noexcept override { return inputs; }
  void pause() noexcept override { ++pauses; }
  [[nodiscard]] bool offsets_connected() const noexcept override { return with_offsets; }
  [[nodiscard]] kernel::signal::AxisValues offset_in_force() const noexcept override {
    return offset_before;
  }
  [[nodiscard]] kernel::signal::AxisValues offset_acceleration() const noexcept override {
    return acceleration;
  }

  kernel::signal::AxisValues acceleration{};  ///< of offsets; 0: not known
  /// A row of each channel of a machine with up to four axes.
  void push(const Sample& sample) {
    push_state(sample);
    push_axes(sample);
  }
  void push_state(const Sample& sample) {
    Row row = sample.state;
    row[0] = static_cast<double>(sample.tick);
    rows[0].push_back(row);
  }
  void push_axes(const Sample& sample) {
    Row row{static_cast<double>(sample.tick)};
    for (std::size_t a = 0; a < kAxesPerChannel; ++a) {
      row[1 + kAxisColumns * a] = sample.axis[a].command;
      row[2 + kAxisColumns * a] = sample.axis[a].actual;
      row[3 + kAxisColumns * a] = sample.axis[a].following_error;
      row[4 + kAxisColumns * a] = sample.axis[a].offset;
    }
    rows[1].push_back(row);
  }

  std::array<std::vector<Row>, kMaxChannels> rows;
  std::array<std::size_t, kMaxChannels> next{};
  std::vector<Pins> written;
  std::size_t pauses = 0;
  bool with_offsets = false;
  kernel::signal::AxisValues offset_before{};
  Inputs inputs;
};

/// Cuts at 66.7 mm/s with all switches at 100 %.
inline Sample cutting(std::uint64_t tick) {
  Sample sample;
  sample.tick = tick;
  sample[Column::tick] = static_cast<double>(tick);
  sample[Column::motion_type] = 3.0;
  sample[Column::program_line] = 5.0;
  sample[Column::path_speed] = 66.7;
  sample[Column::requested_speed] = 66.7;
  sample[Column::feed_mm_s] = 66.7;
  sample[Column::spindle_out_rev_s] = 100.0;
  sample[Column::spindle_in_rev_s] = 99.0;
  sample[Column::enabled] = 1.0;
  sample[Column::feed_panel] = 1.0;
  sample[Column::spindle_panel] = 1.0;
  sample[Column::rapid_panel] = 1.0;
  sample[Column::layer_feed] = 1.0;
  sample[Column::layer_spindle] = 1.0;
  sample[Column::layer_alive] = 1.0;
  sample[Column::mode_auto] = 1.0;
  sample[Column::program_running] = 1.0;
  sample.axis[0] = {10.0, 9.0, 1.0};
  return sample;
}

}  // namespace steadyrest::adapters::linuxcnc::test
