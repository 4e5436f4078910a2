// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// The whole of a machine file as it stands on the disk. Refused: no file, a folder. Of a larger
/// file than is allowed one byte too many is read, which `unfit_text` refuses.
[[nodiscard]] kernel::outcome::Result<std::string> read_text(const std::string& path);

}  // namespace steadyrest::passport
