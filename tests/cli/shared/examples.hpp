// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// What several tests use from examples/.
namespace steadyrest::test {

inline const std::string kSlotProcess = "examples/processes/slot-922hz.toml";
inline const std::string kTapTest = "examples/processes/tap-922hz.csv";
inline const std::string kOnVmc = " --machine examples/machines/vmc-840d.toml";
inline const std::string kPaperWork =
    " --machine examples/paper-thermal/machine.toml --cyclogram "
    "examples/paper-thermal/cyclogram.toml";

}  // namespace steadyrest::test
