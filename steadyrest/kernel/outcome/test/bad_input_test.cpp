// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::kernel::outcome {
namespace {

TEST(BadInput, SaysWhereWhatAndWhatToDo) {
  EXPECT_EQ(text(bad_input("no speed", "give one")), "no speed; give one");
  EXPECT_EQ(text(bad_input("m.toml", "is empty", "fill it")), "m.toml: is empty; fill it");
  EXPECT_EQ(text(bad_input("m.toml", 7, "a = 0", "write 1")), "m.toml:7: a = 0; write 1");
  EXPECT_EQ(bad_input("a", "b").kind, Kind::bad_input);
}

TEST(BadInput, RefusesAsTheErrorOfAResult) {
  const Result<int> result = refuse("m.toml", std::size_t{7}, "a = 0", "write 1");
  ASSERT_FALSE(result);
  EXPECT_EQ(text(result.error()), "m.toml:7: a = 0; write 1");
}

}  // namespace
}  // namespace steadyrest::kernel::outcome
