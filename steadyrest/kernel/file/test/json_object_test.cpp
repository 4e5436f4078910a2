// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/json_object.hpp>

namespace steadyrest::kernel::file {
namespace {

std::string nested(std::size_t depth) {
  return R"({"a":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
}

TEST(JsonObject, IsReadWhole) {
  const auto read = json_object(R"({"b":[1,{"c":null}],"a":"x"})");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->dump(), R"({"b":[1,{"c":null}],"a":"x"})");
}

TEST(JsonObject, IsNoneOfTheRest) {
  for (const char* const text : {"", "[]", "1", "null", "{", R"({"a":1e999})", R"({"a":NaN})",
                                 "{\"a\":\"\xff\"}", R"({"a":1} 2)"}) {
    EXPECT_FALSE(json_object(text)) << text;
  }
}

TEST(JsonObject, IsNestedOnlySoDeep) {
  EXPECT_TRUE(json_object(nested(31)));
  EXPECT_FALSE(json_object(nested(32)));
  EXPECT_FALSE(json_object(nested(200'000)));
  EXPECT_FALSE(json_object(R"({"a":)" + std::string(200'000, '[')));
}

}  // namespace
}  // namespace steadyrest::kernel::file
