// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <steadyrest/kernel/outcome/result.hpp>

/// Files that may be packed.
namespace steadyrest::table {

/// The bytes of a file, unpacked if gzip packed them.
[[nodiscard]] kernel::outcome::Result<std::string> read_packed(const std::string& path);

}  // namespace steadyrest::table
