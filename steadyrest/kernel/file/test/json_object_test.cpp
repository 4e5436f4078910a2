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

TEST(JsonText, SaysInWhichLineItIsNone) {
  EXPECT_FALSE(json_fault(R"({"a": [1, -0.5e-3, "x", null, true], "b": {}})"));
  struct Case {
    const char* text;
    std::size_t line;
    const char* what;
  };
  for (const Case& at : {Case{"{\n\"k\": 1e999\n}", 2, "the number 1e999 is too large"},
                         Case{"{\"a\":\n[1,\n-1e400]}", 3, "the number -1e400 is too large"},
                         Case{"[179769313486231580e292]", 1, "is too large"},
                         Case{"{\n\n,}", 3, "not JSON"}, Case{"", 1, "not JSON"},
                         Case{"{\"a\": nan}", 1, "not JSON"}, Case{"{} x", 1, "not JSON"}}) {
    const auto fault = json_fault(at.text);
    ASSERT_TRUE(fault) << at.text;
    EXPECT_EQ(fault->line, at.line) << at.text;
    EXPECT_NE(fault->what.find(at.what), std::string::npos) << fault->what;
  }
  EXPECT_FALSE(json_object("{\"k\": 1e999}"));
}

}  // namespace
}  // namespace steadyrest::kernel::file
