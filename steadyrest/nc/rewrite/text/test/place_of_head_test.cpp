// SPDX-License-Identifier: Apache-2.0
// Where the head of a corrected program goes, and which programs use what corrections are written
// to: both by the text alone, before anything is run.
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/rewrite/text/place_of_head.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using ::testing::HasSubstr;

Way way_of(Method method) {
  Way way;
  way.method = method;
  way.r_parameter = 50;
  return way;
}

/// The number of the line before which the head goes.
std::uint32_t head_before(Method method, const std::vector<std::string_view>& lines) {
  const Way way = way_of(method);
  PlaceOfHead place(way);
  std::uint32_t number = 0;
  for (const std::string_view line : lines) {
    place.look(line, ++number);
  }
  return place.line();
}

TEST(PlaceOfHead, IsBeforeTheFirstLineThatActs) {
  for (const Method method : {Method::linuxcnc, Method::fanuc, Method::haas, Method::r_parameter,
                              Method::setting_data, Method::frame_fine}) {
    EXPECT_EQ(head_before(method, {"%", "", "  \r", "G21 G90", "G0 X1"}), 4U);
    EXPECT_EQ(head_before(method, {"G0 X1"}), 1U);
    EXPECT_EQ(head_before(method, {"%", ""}), 0U) << "nothing acts";
  }
}

// A FANUC needs its program number first.
TEST(PlaceOfHead, IsBehindTheProgramNumberOfAFanuc) {
  for (const Method method : {Method::fanuc, Method::haas}) {
    EXPECT_EQ(head_before(method, {"%", "O1234 (PLATE)", "G21"}), 3U);
    EXPECT_EQ(head_before(method, {":1234", "G21"}), 2U);
    EXPECT_EQ(head_before(method, {" o0001", "G21"}), 2U);
  }
  EXPECT_EQ(head_before(Method::linuxcnc, {"o100 sub", "G21"}), 1U);
}

// A SINUMERIK wants definitions before the first block that does something: alarm 14500.
TEST(PlaceOfHead, IsBehindTheDefinitionsOfASinumerik) {
  for (const Method method : {Method::r_parameter, Method::setting_data, Method::frame_fine}) {
    EXPECT_EQ(head_before(method, {"PROC PLATE", "N10 DEF REAL DEPTH", "; note", "n20 ; note",
                                   "EXTERN HOLE(REAL)", "DEFINE FAST AS G0", "N30", "G71"}),
              8U);
    // A word that only begins like one of them is not one.
    EXPECT_EQ(head_before(method, {"DEFECT=1", "G71"}), 1U);
    EXPECT_EQ(head_before(method, {"N10 PROCEDURE", "G71"}), 1U);
  }
  EXPECT_EQ(head_before(Method::fanuc, {"DEF", "G21"}), 1U);
}

TEST(OwnUse, OfWhatCorrectionsAreWrittenToIsFound) {
  const struct {
    Method method;
    std::string_view line;
    std::string_view found;
  } cases[] = {{Method::linuxcnc, "#<_steadyrest_z> = 1", "parameters of the corrections"},
               {Method::linuxcnc, "G0 X#<_other>", ""},
               {Method::r_parameter, "R50=3", "may use R50 itself"},
               {Method::r_parameter, "G0 X=R50", "may use R50 itself"},
               {Method::r_parameter, "X=R[R1+3]", "may use R50 itself"},
               {Method::r_parameter, "R5=3 R500=1", ""},
               {Method::r_parameter, "G0 X1 ; R50", ""},
               {Method::setting_data, "$SA_TEMP_COMP_ABS_VALUE[Z]=0", "temperature compensation"},
               {Method::setting_data, "$SA_SPIND_S[0]=1", ""},
               {Method::frame_fine, "$P_UIFR[1,X,TR]=5", "frames' variables"},
               {Method::frame_fine, "$AA_IM[X]", ""},
               // Nothing of a text program names the external offset of a FANUC.
               {Method::fanuc, "R50=3 $P_UIFR #<_steadyrest_z>", ""}};
  for (const auto& one : cases) {
    const std::string use = own_use(way_of(one.method), one.line);
    if (one.found.empty()) {
      EXPECT_EQ(use, "") << one.line;
    } else {
      EXPECT_THAT(use, HasSubstr(std::string(one.found))) << one.line;
    }
  }
}

TEST(OwnUse, HasARemedyForEachMethod) {
  EXPECT_THAT(std::string(against_own_use(way_of(Method::linuxcnc))),
              HasSubstr("another parameter"));
  EXPECT_THAT(std::string(against_own_use(way_of(Method::r_parameter))),
              HasSubstr("another R-parameter"));
  EXPECT_THAT(std::string(against_own_use(way_of(Method::setting_data))),
              HasSubstr("another method"));
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
