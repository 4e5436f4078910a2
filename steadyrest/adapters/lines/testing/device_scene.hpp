// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/adapters/lines/testing/held_wires.hpp>

namespace steadyrest::adapters::lines::testing {

using kernel::machine::Wiring;

// Codes 1, 3, 2, 6: Gray, 0, 50, 100, 120 %.
inline kernel::machine::OverrideTable small_table() {
  kernel::machine::OverrideTable table;
  table.ratio = {0.0, 0.5, 1.0, 1.2};
  table.code = {1, 3, 2, 6};
  return table;
}

inline kernel::machine::Lines lines_of(Wiring wiring) {
  kernel::machine::Lines lines;
  lines.wiring = wiring;
  lines.feed.panel = {0, 1, 2};
  lines.feed.out = {0, 1, 2};
  lines.feed.mask = wiring == Wiring::through ? kernel::machine::kNoLine : 3;
  lines.heartbeat = 4;
  lines.watchdog_s = 0.1;
  return lines;
}

inline constexpr std::uint32_t kLocked = 9;

inline constexpr LineOrder kHalf{.feed = {.code = 3, .masks = true}, .spindle = {}};

/// A device on wires that the test holds, the panel at 100 %.
class DeviceScene {
 public:
  explicit DeviceScene(Wiring wiring, bool latched = true, bool only_looks = false) {
    auto table = small_table();
    table.latched_word = latched;
    auto lines = lines_of(wiring);
    lines.locked = kLocked;
    held.inputs = Levels(2);
    LinesDevice::Parts parts;
    parts.wires = std::make_unique<HeldWires>(held);
    parts.feed =
        OverrideLine::make({.wires = lines.feed, .table = table, .wiring = wiring}).value();
    parts.only_looks = only_looks;
    device = std::make_unique<LinesDevice>(lines, std::move(parts));
  }
  kernel::outcome::Result<void> read() { return device->read(sample); }
  void reads(int times) {
    for (int i = 0; i < times; ++i) {
      ASSERT_TRUE(read());
    }
  }
  void acts(int cycles) {
    for (int i = 0; i < cycles; ++i) {
      ASSERT_TRUE(read());
      ASSERT_TRUE(device->write(kHalf));
    }
  }
  [[nodiscard]] bool masks() const { return held.outputs[3]; }

  Held held;
  LineSample sample;
  std::unique_ptr<LinesDevice> device;
};

}  // namespace steadyrest::adapters::lines::testing
