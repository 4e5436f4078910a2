// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace steadyrest::adapters::opcua {

/// Whether a control's name of a program (`/_N_MPF_DIR/_N_PART1_MPF`, `PART1.MPF`) may be that of a
/// file: letters and digits of the last part alone count, without extension; names of the control
/// have no others but `_`.
[[nodiscard]] bool same_program(std::string_view shown, std::string_view file);

}  // namespace steadyrest::adapters::opcua
