// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>

/// Override tables from manuals and from one real machine's archive; for tests only, since a table
/// is machine data.
namespace steadyrest::kernel::override::test {

/// 23-position feed switch of the SINUMERIK 840D machine control panel.
inline machine::OverrideTable feed_840d() {
  machine::OverrideTable table;
  for (const double percent : {0,  1,  2,  4,  6,  8,  10,  20,  30,  40,  50, 60,
                               70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120}) {
    table.ratio.push_back(percent / 100.0);
  }
  return table;
}

/// Spindle switch of the same control: MD12070, 50 … 120 % by 5 %.
inline machine::OverrideTable spindle_840d() {
  machine::OverrideTable table;
  for (int percent = 50; percent <= 120; percent += 5) {
    table.ratio.push_back(percent / 100.0);
  }
  return table;
}

/// MD12030[0 … 30] of a DMG machine with 840D sl: 100 % is at index 24.
inline machine::OverrideTable feed_dmg() {
  machine::OverrideTable table;
  table.ratio = {0,   .005, .01, .02,  .03,  .04,  .05,  .06,  .07, .08, .09,
                 .10, .15,  .20, .30,  .40,  .50,  .60,  .70,  .75, .80, .85,
                 .90, .95,  1.0, 1.05, 1.10, 1.15, 1.20, 1.30, 1.50};
  return table;
}

/// Binary word as percent, 0 … 200 (the control's binary mode).
inline machine::OverrideTable percent_word() {
  machine::OverrideTable table;
  table.coding = machine::Coding::binary;
  for (std::uint32_t percent = 0; percent <= 200; ++percent) {
    table.ratio.push_back(percent / 100.0);
    table.code.push_back(percent);
  }
  return table;
}

}  // namespace steadyrest::kernel::override::test
