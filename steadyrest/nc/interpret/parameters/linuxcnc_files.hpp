// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>

namespace steadyrest::nc::interpret {

/// Reads a LinuxCNC tool table: one tool per line, `T1 P1 X0 Y0 Z12.5 D6 ;comment`. Lengths are in
/// machine units: `unit_mm` is 1 or 25.4. Words other than T P X Y Z A B C U V W D I J Q are
/// refused.
kernel::outcome::Result<std::vector<Tool>> read_tool_table(const std::string& path, double unit_mm);

/// Reads a LinuxCNC variable file (`5221  12.5`) into a configuration: G28 (5161…), G30 (5181…),
/// G92 (5210…), active work offset (5220) and the nine work offsets (5221…), other numbers
/// unchanged; sets `start_known`. The rotation of a work offset follows its nine values (5230,
/// 5250, …).
kernel::outcome::Result<void> read_variables(const std::string& path, double unit_mm,
                                             Config& config);

}  // namespace steadyrest::nc::interpret
