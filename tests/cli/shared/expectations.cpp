// SPDX-License-Identifier: Apache-2.0
#include "expectations.hpp"

#include "program.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace steadyrest::test {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

json answer_of(const std::string& line) {
  const Finished finished = run_line(line + " --json");
  EXPECT_EQ(finished.code, 0) << line << "\n" << finished.err;
  EXPECT_THAT(finished.err, IsEmpty()) << line;
  return finished.code == 0 ? json::parse(finished.out) : json{};
}

void expect_refused(const std::string& line, const std::string& why) {
  const Finished finished = run_line(line);
  EXPECT_EQ(finished.code, 2) << line;
  EXPECT_THAT(finished.out, IsEmpty()) << line;
  EXPECT_THAT(finished.err, MatchesRegex("steadyrest: .*; .*\n")) << line;
  EXPECT_THAT(finished.err, HasSubstr(why)) << line;
}

void expect_all_refused(std::initializer_list<std::string> lines) {
  for (const std::string& line : lines) {
    expect_refused(line);
  }
}

}  // namespace steadyrest::test
