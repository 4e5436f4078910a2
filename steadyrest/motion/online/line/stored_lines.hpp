// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/motion/online/line/line_table.hpp>

namespace steadyrest::motion::online {

/// The line table of an encoder in the machine file; without calibration a table that leaves every
/// line where it is. It does not learn.
[[nodiscard]] kernel::outcome::Result<LineTable> stored_lines(
    const kernel::machine::Encoder& encoder);

/// Writes a table to the machine file's encoder.
void store_lines(const LineTable& table, kernel::machine::Encoder& encoder);

}  // namespace steadyrest::motion::online
