// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// The circle that the tests ask `contour limit` about.
namespace steadyrest::test {

inline const std::string kLimit = "contour limit --radius-mm 10 --kv-1-s 50 ";

}  // namespace steadyrest::test
