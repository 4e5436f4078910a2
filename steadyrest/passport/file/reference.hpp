// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace steadyrest::passport {

/// docs/machine-file.md: every key with unit, range, default and meaning, from the schema's tables.
[[nodiscard]] std::string reference_page();

}  // namespace steadyrest::passport
