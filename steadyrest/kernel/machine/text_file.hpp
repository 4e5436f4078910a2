// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::kernel::machine {

/// The whole of a machine file as it stands on the disk. Refused: no file, a folder. Of a larger
/// file than is allowed one byte too many is read, which `unfit_text` refuses.
[[nodiscard]] outcome::Result<std::string> read_text(const std::string& path);

}  // namespace steadyrest::kernel::machine
