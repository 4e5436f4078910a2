// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/walk/walk.hpp>

namespace steadyrest::nc::rewrite::test {

/// A workshop that walks through a program.
class WalkShop : public Workshop {
 public:
  /// Calls `look` at each line.
  void walk(const std::string& program, const std::function<void(const Walk&)>& look) const {
    write_file(original(), program);
    // As compensate() does: no offset is 0 by chance.
    const interpret::Config unknown = with_unknown_offsets(config, way);
    const auto surveyed = survey(original(), unknown);
    ASSERT_TRUE(surveyed.has_value()) << program;
    const auto walk = Walk::make(original(), unknown, *surveyed, way).value();
    while (walk->step()) {
      look(*walk);
    }
    EXPECT_TRUE(walk->take().refused.empty()) << program;
  }

  Way way;
};

}  // namespace steadyrest::nc::rewrite::test
