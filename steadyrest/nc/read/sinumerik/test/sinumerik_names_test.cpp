// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/nc/read/sinumerik/sinumerik_names.hpp>

namespace steadyrest::nc::read {
namespace {

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  });
  return text;
}
std::string why_refused(const std::string& name) {
  const RefusedName* const refused = refused_name(name);
  return refused == nullptr ? "" : std::string{refused->reason};
}

// Lists of the manuals: the words of README.md that the interpreter executes or leaves without
// effect.
TEST(SinumerikNames, AreKnownInAnyCaseAndAsAWhole) {
  for (const char* name :
       {"CR",     "TURN",    "SUPA",   "ADIS",  "ADISPOS",   "FNORM", "CFC",       "CFTCP",
        "CFIN",   "FFWOF",   "SOFT",   "RET",   "TRAFOOF",   "TRANS", "ATRANS",    "ROT",
        "AROT",   "RPL",     "STOPRE", "CIP",   "CT",        "AR",    "RP",        "AP",
        "COMPOF", "COMPCAD", "CTOL",   "BRISK", "FLIN",      "FFWON", "DYNFINISH", "FGROUP",
        "SPOS",   "LIMS",    "DIAMON", "SETAL", "WORKPIECE", "UPATH", "ORIMKS"}) {
    const std::string written{name};
    EXPECT_TRUE(known_name(written)) << written;
    EXPECT_TRUE(known_name(in_small_letters(written))) << written;
    EXPECT_FALSE(known_name(written + 'X')) << written;
    const std::string shorter = written.substr(0, written.size() - 1);
    EXPECT_EQ(known_name(shorter), shorter == "RP") << written;  // RPL: RP is a word, too
    EXPECT_EQ(why_refused(written), "") << written;  // a word is known or refused, never both
  }
}

// "Job planning", control structures: all of them would change the order of the blocks.
TEST(SinumerikNames, OfControlStructuresAreRefusedForThat) {
  for (const char* name :
       {"IF", "ELSE", "ENDIF", "FOR", "ENDFOR", "WHILE", "ENDWHILE", "LOOP", "ENDLOOP", "REPEAT",
        "UNTIL", "CASE", "GOTO", "GOTOF", "GOTOB", "GOTOC", "GOTOS", "REPEATB"}) {
    EXPECT_EQ(why_refused(name), "flow_control") << name;
    EXPECT_EQ(why_refused(in_small_letters(name)), "flow_control") << name;
    EXPECT_FALSE(known_name(name)) << name;
    // The text names the word, so that a reader of the refusal need not look for it.
    EXPECT_NE(refused_name(name)->text.find(std::string{"("} + name + ")"), std::string::npos);
  }
}

TEST(SinumerikNames, OfFramesTransformationsAndCallsHaveReasonsOfTheirOwn) {
  for (const char* name : {"SCALE", "ASCALE", "MIRROR", "AMIRROR", "ROTS", "AROTS"}) {
    EXPECT_EQ(why_refused(name), "frame") << name;
  }
  for (const char* name : {"TRAORI", "TRANSMIT", "TRACYL"}) {
    EXPECT_EQ(why_refused(name), "transformation") << name;
  }
  EXPECT_EQ(why_refused("CALL"), "subprogram_call");
  EXPECT_EQ(why_refused("PCALL"), "subprogram_call");
  for (const char* name : {"A3", "B3", "C3", "LEAD", "TILT"}) {
    EXPECT_EQ(why_refused(name), "orientation") << name;
  }
  for (const char* name : {"RND", "RNDM", "CHF", "CHR"}) {
    EXPECT_EQ(why_refused(name), "corner") << name;
  }
  EXPECT_EQ(why_refused("WAITM"), "channels");
  for (const char* name : {"OVR", "POS", "BSPLINE", "POLY", "G0X"}) {
    EXPECT_EQ(why_refused(name), name[0] == 'G' ? "" : "unknown_word") << name;
    EXPECT_FALSE(known_name(name)) << name;
  }
  EXPECT_EQ(why_refused("POCKET"), "");
  EXPECT_EQ(why_refused(""), "");
}

}  // namespace
}  // namespace steadyrest::nc::read
