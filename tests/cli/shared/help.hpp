// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace steadyrest::test {

using Words = std::vector<std::string>;

/// The output of `steadyrest PATH… --help`.
std::string help_of(Words path);

/// Every path that leads to a verb, found in the help.
std::vector<Words> verbs(const Words& path = {});

std::string joined(const Words& words);

}  // namespace steadyrest::test
