// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <map>
#include <string>

#include "examples.hpp"
#include "expectations.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace steadyrest::test {
namespace {

using testing::HasSubstr;

const std::string kFeedsPart = "examples/programs/rib-pocket.mpf";
const std::string kOnSlowMill = " --machine examples/machines/linuxcnc-mill.toml";

/// Of bench/clairvoyant: the best schedule of the 23 override steps for this part and machine.
constexpr double kBestSteps_s = 203.2;

std::string within_mm(double error_mm) {
  return " --max-error-mm " + std::to_string(error_mm);
}

// Feeds of any value, without dead time, beat the best schedule of 23 steps. The simulated machine
// has its friction, backlash and encoders, of which the model knows nothing.
TEST(ProgramFeeds, KeepsTheLimitFasterThanTheBestScheduleOfOverrideSteps) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.mpf");
  const auto answer =
      answer_of("program feeds " + kFeedsPart + kOnVmc + within_mm(0.010) + " -o " + changed);
  EXPECT_NEAR(answer["seconds_before"].get<double>(), 110.86, 0.1);
  EXPECT_LT(answer["seconds_after"].get<double>(), 0.92 * kBestSteps_s);
  EXPECT_LT(answer["share_over_limit"].get<double>(), 0.001);
  const auto cut = answer_of("cut " + changed + " --quick" + kOnVmc)["without"];
  EXPECT_LE(cut["samples_over_limit"].get<double>(), 0.001 * cut["samples"].get<double>());
  EXPECT_NEAR(cut["cycle_time_s"].get<double>(), answer["seconds_after"].get<double>(), 0.1);
  // What remains is two right angles.
  ASSERT_EQ(answer["remaining"].size(), 2U);
  for (const auto& one : answer["remaining"]) {
    EXPECT_THAT(one["line"].get<int>(), testing::AnyOf(213, 214));
    EXPECT_EQ(one["reason"], "the lowest feed permitted");
    EXPECT_LT(one["predicted_error_mm"].get<double>(), 0.030);
  }
  const auto removed = answer_of("program strip " + changed + " -o " + scratch.at("back.mpf"));
  EXPECT_GT(removed["removed_lines"].get<int>(), 200);
  EXPECT_EQ(text_of_file(scratch.at("back.mpf")), text_of_file(project_file(kFeedsPart)));
}

TEST(ProgramFeeds, HoldsOnASlowServoToo) {
  const Scratch scratch;
  const std::string changed = scratch.at("changed.ngc");
  const auto answer = answer_of("program feeds examples/programs/rib-pocket.ngc" + kOnSlowMill +
                                within_mm(0.010) + " -o " + changed);
  // The governor, on line with 201 steps, takes 362.7 s.
  EXPECT_LT(answer["seconds_after"].get<double>(), 345.0);
  const auto cut = answer_of("cut " + changed + " --quick" + kOnSlowMill)["without"];
  EXPECT_LE(cut["samples_over_limit"].get<double>(), 0.007 * cut["samples"].get<double>());
  // Beyond the feed's reach: rapids whose lag lasts into the cut; sharp corners.
  for (const auto& one : answer["remaining"]) {
    EXPECT_NE(one["reason"], "its block must stay") << one;
  }
  EXPECT_EQ(answer["kept"][0]["lines"].size(), 4U) << "the drilling cycle";
}

// R = 10 mm, k = 50 1/s: v = k·R·√((R/(R − ε))² − 1), less what is kept back.
TEST(ProgramFeeds, WritesTheClosedFormsFeedForACircle) {
  const Scratch scratch;
  std::ofstream(scratch.at("circle.mpf"))
      << "N10 G17 G71 G90 G94 G64\nN20 G0 X10 Y-30\nN30 G4 F1\nN40 G1 Y0 F4000\n"
         "N50 G3 X10 Y0 I-10 J0 TURN=2\nN60 G1 Y30\nN70 M30\n";
  const std::string ideal = " --machine examples/machines/ideal-k50.toml";
  const auto answer =
      answer_of("program feeds " + scratch.at("circle.mpf") + ideal + " " + within_mm(0.010) +
                " --dialect sinumerik -o " + scratch.at("out.mpf"));
  const auto closed = answer_of("contour limit --radius-mm 10 --kv-1-s 50 --max-error-mm " +
                                std::to_string(answer["limit_mm"].get<double>()));
  const std::string text = text_of_file(scratch.at("out.mpf"));
  // The parts of the two turns have the same F.
  std::map<std::string, int> arcs;
  for (std::size_t at = text.find("\nG3 "); at != std::string::npos;
       at = text.find("\nG3 ", at + 1)) {
    const std::size_t feed = text.find('F', at) + 1;
    ++arcs[text.substr(feed, text.find(' ', feed) - feed)];
  }
  const auto steady =
      std::ranges::max_element(arcs, {}, [](const auto& one) { return one.second; });
  ASSERT_GE(steady->second, 2);
  EXPECT_NEAR(std::stod(steady->first), closed["feed_mm_min"].get<double>(),
              0.01 * closed["feed_mm_min"].get<double>())
      << text;
}

TEST(ProgramFeeds, LeavesAProgramThatKeepsTheLimit) {
  const Scratch scratch;
  const std::string program = "examples/programs/slot.mpf";
  const auto answer = answer_of("program feeds " + program + kOnVmc + within_mm(0.5) + " -o " +
                                scratch.at("out.mpf"));
  EXPECT_TRUE(answer["unchanged"].get<bool>());
  EXPECT_EQ(answer["replaced_lines"], 0);
  EXPECT_EQ(text_of_file(scratch.at("out.mpf")), text_of_file(project_file(program)));
}

TEST(ProgramFeeds, SaysWhyABlockStays) {
  const Scratch scratch;
  std::ofstream(scratch.at("part.ngc"))
      << "G21 G90 G94 G17 G61\nG0 X0 Y0\nG4 P1\nG1 X20 F3000\nG2 X20 Y-10 I0 J[0-5]\n"
         "G1 X0\nG2 X0 Y0 I0 J5\nM2\n";
  const auto answer = answer_of("program feeds " + scratch.at("part.ngc") + kOnSlowMill +
                                within_mm(0.010) + " -o " + scratch.at("out.ngc"));
  ASSERT_EQ(answer["kept"].size(), 1U);
  EXPECT_EQ(answer["kept"][0]["reason"], "its words hold parameters or expressions");
  EXPECT_EQ(answer["kept"][0]["lines"], nlohmann::json::array({5}));
  const auto& remaining = answer["remaining"];
  EXPECT_TRUE(std::ranges::any_of(remaining, [](const auto& one) {
    return one["line"] == 5 && one["reason"] == "its block must stay";
  })) << remaining;
}

TEST(ProgramFeeds, RefusesWhatItCannotDo) {
  const Scratch scratch;
  const std::string to = " -o " + scratch.at("out.mpf");
  const std::string twice = scratch.at("twice.mpf");
  answer_of("program feeds " + kFeedsPart + kOnVmc + within_mm(0.010) + " -o " + twice);
  expect_refused("program feeds " + twice + kOnVmc + within_mm(0.010) + to, "replaced already");
  expect_refused("program feeds " + kFeedsPart + kOnVmc + within_mm(0.0011) + to, "leaves nothing");
  std::ofstream(scratch.at("rapids.mpf")) << "N10 G90 G71\nN20 G0 X10\nN30 M30\n";
  expect_refused("program feeds " + scratch.at("rapids.mpf") + kOnVmc + within_mm(0.010) + to,
                 "no feed moves");
  expect_all_refused(
      {"program feeds " + kFeedsPart + within_mm(0.010) + to,
       "program feeds " + kFeedsPart + kOnVmc + to,
       "program feeds " + kFeedsPart + kOnVmc + within_mm(0.010),
       "program feeds " + kFeedsPart + kOnVmc + " --max-error-mm 0" + to,
       "program feeds " + kFeedsPart + kOnVmc + " --max-error-mm -1" + to,
       "program feeds " + kFeedsPart + kOnVmc + " --max-error-mm 100" + to,
       "program feeds examples/machines/vmc-840d.toml" + kOnVmc + within_mm(0.010) + to});
}

}  // namespace
}  // namespace steadyrest::test
