// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <string_view>

#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/live/control_socket.hpp>

namespace steadyrest::test {
namespace {

using ::testing::HasSubstr;

/// What `status` says for people of a layer on LinuxCNC at this place of a program.
std::string text_at(const std::string& place, const std::string& words) {
  const Scratch scratch;
  const auto socket = live::ControlSocket::open(scratch.at("s"), [&](std::string_view) {
    return R"({"version":1,"status":{"program":{"file":"a.ngc","segments":2,"place":")" + place +
           R"(","words":)" + words + "}}}";
  });
  EXPECT_TRUE(socket.has_value());
  return run_line("status --socket " + scratch.at("s")).out;
}

TEST(Status, SaysWhereTheControlIsOnItsProgram) {
  EXPECT_THAT(text_at("on_path", "null"), HasSubstr("on the path of a.ngc\n"));
  EXPECT_THAT(text_at("off_path", "\"a corner\""),
              HasSubstr("off the planned path of a.ngc here\n"));
  EXPECT_THAT(text_at("searching", "\"several places\""),
              HasSubstr("looking for the place on a.ngc: several places\n"));
  EXPECT_THAT(text_at("start_unseen", "\"begin it again\""),
              HasSubstr("looking for the place on a.ngc: begin it again\n"));
  EXPECT_THAT(text_at("no_route", "\"it has changed\""), HasSubstr("no path: it has changed\n"));
}

}  // namespace
}  // namespace steadyrest::test
