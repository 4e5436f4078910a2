// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "sources_in_memory.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace house {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// kernel below the rooms; within nc, interpret below plan but above read.
TEST(Floors, ALowerFloorMayBeIncluded) {
  EXPECT_THAT(
      found("steadyrest/contour/online/x.hpp", "#include <steadyrest/kernel/port/port.hpp>"),
      IsEmpty());
  EXPECT_THAT(
      found("steadyrest/nc/plan/x.hpp", "#include <steadyrest/nc/interpret/state/move.hpp>"),
      IsEmpty());
  EXPECT_THAT(
      found("steadyrest/nc/read/x.hpp", "#include <steadyrest/nc/interpret/state/move.hpp>"),
      ElementsAre("floor:2"));
  EXPECT_THAT(found("steadyrest/apps/cli/x.cpp", "#include <steadyrest/adapters/replay/x.hpp>"),
              IsEmpty());
}

TEST(Floors, AHigherFloorMustNotBeIncluded) {
  EXPECT_THAT(found("steadyrest/kernel/port/x.hpp", "#include <steadyrest/math/lu.hpp>"),
              ElementsAre("floor:2"));
  EXPECT_THAT(found("steadyrest/nc/plan/x.cpp", "\n#include <steadyrest/sim/axis.hpp>"),
              ElementsAre("floor:3"));
  EXPECT_THAT(found("steadyrest/contour/x.hpp", "#include <steadyrest/supervisor/cycle.hpp>"),
              ElementsAre("floor:2"));
}

TEST(Floors, MathDoesNotKnowPrograms) {
  EXPECT_THAT(found("steadyrest/nc/plan/x.hpp", "#include <steadyrest/math/geometry/segment.hpp>"),
              IsEmpty());
  EXPECT_THAT(found("steadyrest/math/x.hpp", "#include <steadyrest/nc/interpret/state/move.hpp>"),
              ElementsAre("floor:2"));
}

// All sixteen pairs.
TEST(Floors, RoomsNeverMeet) {
  const std::vector<std::string> rooms = {"motion", "contour", "chatter", "thermal"};
  for (const std::string& here : rooms) {
    for (const std::string& there : rooms) {
      const auto result = found("steadyrest/" + here + "/online/x.hpp",
                                "#include <steadyrest/" + there + "/online/y.hpp>");
      EXPECT_EQ(result.empty(), here == there) << here << " → " << there;
    }
  }
}

TEST(Floors, TheSupervisorKnowsOnlineHalvesOnly) {
  const std::string path = "steadyrest/supervisor/cycle.hpp";
  EXPECT_THAT(found(path, "#include <steadyrest/contour/online/x.hpp>"), IsEmpty());
  EXPECT_THAT(found(path, "#include <steadyrest/contour/offline/x.hpp>"), ElementsAre("floor:2"));
  EXPECT_THAT(found(path, "#include <steadyrest/contour/x.hpp>"), ElementsAre("floor:2"));
  EXPECT_THAT(found(path, "#include <steadyrest/sim/x.hpp>"), ElementsAre("floor:2"));
}

TEST(Floors, AnAdapterKnowsTheKernelAlone) {
  const std::string path = "steadyrest/adapters/linuxcnc/pins.hpp";
  EXPECT_THAT(found(path, "#include <steadyrest/kernel/port/port.hpp>"), IsEmpty());
  EXPECT_THAT(found(path, "#include <steadyrest/adapters/linuxcnc/hal.hpp>"), IsEmpty());
  EXPECT_THAT(found(path, "#include <steadyrest/adapters/modbus/x.hpp>"), ElementsAre("floor:2"));
  EXPECT_THAT(found(path, "#include <steadyrest/math/x.hpp>"), ElementsAre("floor:2"));
}

TEST(Floors, TheSimulatedMachineDoesNotKnowTheLayer) {
  const std::string path = "steadyrest/sim/axis.hpp";
  EXPECT_THAT(found(path, "#include <steadyrest/nc/plan/time/setpoint.hpp>"), IsEmpty());
  EXPECT_THAT(found(path, "#include <steadyrest/contour/online/x.hpp>"), ElementsAre("floor:2"));
  EXPECT_THAT(found(path, "#include <steadyrest/supervisor/x.hpp>"), ElementsAre("floor:2"));
}

TEST(Floors, AFolderWithoutAPlaceIsRefused) {
  EXPECT_THAT(found("steadyrest/attic/x.hpp", ""), ElementsAre("place:1"));
  EXPECT_THAT(found("steadyrest/apps/x.hpp", "#include <steadyrest/attic/y.hpp>"),
              ElementsAre("place:2"));
}

// An include in a comment, a block comment or a raw string is not an include; one with blanks after
// # is.
TEST(Includes, InCommentsAndStringsDoNotCount) {
  const std::string higher = "#include <steadyrest/apps/x.hpp>";
  const std::string path = "steadyrest/kernel/x.hpp";
  EXPECT_THAT(found(path, "// " + higher), IsEmpty());
  EXPECT_THAT(found(path, "/*\n" + higher + "\n*/"), IsEmpty());
  EXPECT_THAT(found(path, "const char* s = R\"(\n" + higher + "\n)\";"), IsEmpty());
  EXPECT_THAT(found(path, "#  include <steadyrest/apps/x.hpp>"), ElementsAre("floor:2"));
}

TEST(Includes, OwnHeadersStandInAngleBrackets) {
  EXPECT_THAT(found("steadyrest/kernel/x.hpp", "#include \"y.hpp\""),
              ElementsAre("quoted-include:2"));
  EXPECT_THAT(found("steadyrest/kernel/x.hpp", "#include \"steadyrest/apps/y.hpp\""),
              ElementsAre("floor:2"));
}

TEST(Halves, OnlineNeverIncludesOffline) {
  EXPECT_THAT(
      found("steadyrest/contour/online/x.hpp", "#include <steadyrest/contour/offline/y.hpp>"),
      ElementsAre("floor:2", "half:2"));
  EXPECT_THAT(
      found("steadyrest/contour/offline/x.hpp", "#include <steadyrest/contour/online/y.hpp>"),
      IsEmpty());
}

TEST(Shelves, IncludeTheirOwnAndLowerOnes) {
  const std::string include = "#include <steadyrest/chatter/offline/";
  EXPECT_THAT(shelved("steadyrest/chatter/offline/depth/x.hpp", include + "cycle/y.hpp>"),
              IsEmpty());
  EXPECT_THAT(shelved("steadyrest/chatter/offline/depth/x.hpp", include + "depth/y.hpp>"),
              IsEmpty());
  EXPECT_THAT(shelved("steadyrest/chatter/offline/cycle/x.cpp", include + "depth/y.hpp>"),
              ElementsAre("shelf:2"));
}

TEST(Shelves, WhatLiesBesideThemIsAboveThemAll) {
  EXPECT_THAT(found("steadyrest/sim/x.hpp", "#include <steadyrest/sim/panel/y.hpp>"), IsEmpty());
  const SourceFile lower{
      "steadyrest/sim/panel/x.hpp",
      std::string(kSpdx) + "#include <steadyrest/sim/y.hpp>\nnamespace steadyrest::sim {}\n"};
  EXPECT_THAT(found(lower), ElementsAre("shelf:2"));
}

TEST(Shelves, TestsMayUseTheHelpersOfOtherTests) {
  const SourceFile test{"steadyrest/sim/axis/test/x_test.cpp",
                        std::string(kSpdx) + "#include <steadyrest/sim/test/rig.hpp>\n"};
  EXPECT_THAT(found(test), IsEmpty());
}

TEST(Shelves, ShareTheNamespaceOfTheirPlace) {
  const std::string text(kSpdx);
  EXPECT_THAT(found({"steadyrest/sim/axis/x.hpp", text + "namespace steadyrest::sim {}\n"}),
              IsEmpty());
  EXPECT_THAT(found({"steadyrest/sim/axis/x.hpp", text + "namespace steadyrest::sim::heat {}\n"}),
              IsEmpty());
  EXPECT_THAT(found({"steadyrest/sim/axis/x.hpp", text + "namespace steadyrest::nc {}\n"}),
              ElementsAre("namespace:2", "namespace:1"));
}

}  // namespace
}  // namespace house
