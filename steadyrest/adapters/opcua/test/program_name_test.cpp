// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/program_name.hpp>

namespace steadyrest::adapters::opcua {
namespace {

TEST(ProgramName, AControlsNamesOfAFile) {
  for (const char* const shown : {"/_N_MPF_DIR/_N_CIRCLE_R10_MPF", "CIRCLE_R10.MPF", "circle-r10",
                                  "/WKS.DIR/PARTS.WPD/CIRCLE_R10.MPF"}) {
    EXPECT_TRUE(same_program(shown, "/home/cnc/parts/circle-r10.mpf")) << shown;
  }
}

TEST(ProgramName, OtherProgramsAreOthers) {
  for (const char* const shown : {"/_N_MPF_DIR/_N_CIRCLE_R12_MPF", "CIRCLE.MPF", "R10", "L"}) {
    EXPECT_FALSE(same_program(shown, "/home/cnc/parts/circle-r10.mpf")) << shown;
  }
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
