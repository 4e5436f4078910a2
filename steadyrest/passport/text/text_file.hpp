// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::passport {

/// The whole machine file from the disk. Refused: no file, a folder. Of an oversized file one byte
/// more than allowed is read, which `unfit_text` refuses.
[[nodiscard]] kernel::outcome::Result<std::string> read_text(const std::string& path);

}  // namespace steadyrest::passport
