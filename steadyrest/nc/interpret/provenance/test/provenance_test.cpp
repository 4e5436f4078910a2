// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/interpret/program.hpp>

// What is known behind each line. The truth is the law in provenance.hpp; that no program is
// corrected that moves otherwise for another answer, rs274 shows (scripts/rs274_unknown.py).
namespace steadyrest::nc::interpret {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::string_view kHead = "G21 G90 G17 G54 G94 F600\nG0 X0 Y0 Z0\n";

class Nowhere final : public Sink {
 public:
  void on_move(const Move& /*move*/) override {}
  void on_event(const Event& /*event*/) override {}
};

struct Seen {
  Doubt last;              ///< of the last line before M2
  std::vector<int> lines;  ///< that depend on the control, without the head's two
  std::vector<Assumed> assumed;
  std::string refused;
};

/// `body` between the head and M2.
Seen seen(const std::string& body, const Config& config = {}) {
  const std::string text = std::string(kHead) + body + "M2\n";
  auto source = read::LineSource::from_text(text);
  Nowhere nowhere;
  auto run = ProgramRun::make(source, config, nowhere);
  Seen out;
  Doubt before;
  while (run->step()) {
    out.last = before;
    before = run->doubt();
    const int line = static_cast<int>(run->line()) - 2;
    if (before.line && std::ranges::find(out.lines, line) == out.lines.end()) {
      out.lines.push_back(line);
    }
  }
  auto report = run->take();
  out.assumed = std::move(report.unknown);
  out.refused = report.refused.empty() ? "" : report.refused.front().reason;
  return out;
}

bool lost(const Seen& what, ModeMask modes) {
  return (what.last.lost & modes) == modes;
}
/// Axes of X Y Z that are not known where `G1 X1` begins behind the body.
std::string unknown_axes(const std::string& body, const Config& config = {}) {
  const Seen what = seen(body + "G1 X1\n", config);
  std::string axes;
  for (int i = 0; i < 3; ++i) {
    axes += (what.last.axes >> i & 1U) != 0 ? std::string(1, "XYZ"[i]) : "";
  }
  return axes;
}

TEST(Provenance, NamesEachValueOfTheControlOnceWithItsLine) {
  const Seen what = seen("#1=#100\n#2=[#100+#<_task>]\nS[100+#1] M3\n");
  ASSERT_EQ(what.assumed.size(), 2U);
  EXPECT_EQ(what.assumed[0].name, "#100");
  EXPECT_EQ(what.assumed[0].line, 3U);
  EXPECT_EQ(what.assumed[1].name, "#<_task>");
  EXPECT_EQ(what.assumed[1].line, 4U);
  EXPECT_THAT(what.lines, IsEmpty());
}

TEST(Provenance, KnowsWhatTheTextHasSet) {
  EXPECT_THAT(seen("#1=5\n#100=#1\nG1 X[#100+#<_x>] F[#100*60]\n").assumed, IsEmpty());
  EXPECT_THAT(seen("#1=#<_absolute>\n#2=#5220\n#3=#5421\n").assumed, IsEmpty());
  EXPECT_EQ(unknown_axes(""), "");
}

TEST(Provenance, TakesAGivenFileForKnown) {
  Config config;
  config.start_known = true;
  config.numbers = {{100, 2.0}};
  EXPECT_THAT(seen("G1 X#100\nG1 Y#5221\n", config).assumed, IsEmpty());
  EXPECT_EQ(seen("G1 X#100\n").assumed.size(), 1U);
}

TEST(Provenance, TheTaskIsOneOnAMachineAndStillNoConstant) {
  Config config;
  config.on_machine = true;
  const std::string guard = "o1 if [#<_task> EQ 1]\nG91\no1 endif\n";
  const Seen what = seen(guard + "G4 P0\n", config);
  EXPECT_THAT(what.assumed, IsEmpty());
  EXPECT_TRUE(lost(what, mode(GGroup::distance)));
  EXPECT_EQ(seen(guard).assumed.size(), 1U);
}

TEST(Provenance, AModeSetOrSkippedInDoubtIsLostUntilTheTextSetsIt) {
  for (const std::string condition :
       {"[#5399 EQ 1]", "[#5399 EQ 0]", "[#100]", "[EXISTS[#<_q>]]"}) {
    const std::string guard = "M66 P0 L0\no1 if " + condition + "\nG91\no1 endif\n";
    EXPECT_TRUE(lost(seen(guard + "G4 P0\n"), mode(GGroup::distance))) << condition;
    EXPECT_FALSE(lost(seen(guard + "G90\nG4 P0\n"), mode(GGroup::distance))) << condition;
    EXPECT_FALSE(lost(seen(guard + "G4 P0\n"), mode(GGroup::plane))) << condition;
    // In G91 or G90, X may be anywhere.
    EXPECT_EQ(unknown_axes(guard + "G1 X5\n"), "X") << condition;
    EXPECT_EQ(unknown_axes(guard + "G1 X5\nG90 G0 X1\n"), "") << condition;
  }
}

TEST(Provenance, AParameterSetInDoubtIsUnknownUntilItIsSetAgain) {
  const std::string guard = "#1=1\no1 if [#100 EQ 1]\n#1=2\no1 endif\n";
  EXPECT_EQ(unknown_axes(guard + "G1 Y#1\n"), "Y");
  EXPECT_EQ(unknown_axes(guard + "#1=3\nG1 Y#1\n"), "");
  EXPECT_EQ(unknown_axes("#<a>=1\no1 if [#100 EQ 1]\n#<a>=2\no1 endif\nG1 Y#<a>\n"), "Y");
  EXPECT_EQ(unknown_axes("#7=#100\n#[1+#7]=4\n#3=1\nG1 X#3\n"), "");
  EXPECT_EQ(unknown_axes("#3=1\n#7=#100\n#[3+#7]=4\nG1 X#3\n"), "X");
}

TEST(Provenance, HarmlessUnknownsChangeNoPlace) {
  const Seen what = seen(
      "M66 P0 L0\no1 if [#5399 EQ 1]\n(MSG,door open)\nM8\nS500 M3\nG4 P1\no1 endif\n"
      "G4 P[#100*0.1]\nS[#100+50]\nM62 P1\nG4 P0\n");
  EXPECT_THAT(what.lines, IsEmpty());
  EXPECT_EQ(what.last.lost & mode(GGroup::distance), 0U);
  EXPECT_EQ(unknown_axes("o1 do\nM66 P0 L0\nG4 P1\no1 while [#5399 EQ 1]\n"), "");
}

TEST(Provenance, ALoopsTurnsAreInDoubtWithItsCount) {
  EXPECT_EQ(unknown_axes("o1 repeat [1+#100]\nG91 G1 X1\no1 endrepeat\nG90\n"), "X");
  EXPECT_EQ(unknown_axes("o1 repeat [#100]\nG1 Y2\no1 endrepeat\n"), "Y");
  EXPECT_EQ(unknown_axes("o1 do\nG1 Z2\no1 while [#100 GT 1]\n"), "Z");
  EXPECT_EQ(unknown_axes("#1=0\no1 while [#1 LT 2+#100]\n#1=[#1+1]\nG1 Y#1\no1 endwhile\n"), "Y");
  EXPECT_EQ(unknown_axes("#1=0\no1 while [#1 LT 2]\n#1=[#1+1]\nG1 Y#1\no1 endwhile\n"), "");
}

TEST(Provenance, LeavingInDoubtReachesToTheEndOfTheLoopOrSubprogram) {
  const std::string loop =
      "#1=0\no1 while [#1 LT 3]\n#1=[#1+1]\no2 if [#100 EQ 1]\no1 break\no2 endif\nG1 Y#1\n"
      "o1 endwhile\n";
  EXPECT_EQ(unknown_axes(loop), "XYZ");
  EXPECT_EQ(unknown_axes(loop + "G21 G8 G90 G17 G0 X0 Y0 Z0\n"), "");
  const std::string sub =
      "o9 sub\no2 if [#100 EQ 1]\no9 return\no2 endif\nG1 Y5\no9 endsub\no9 call\n";
  EXPECT_EQ(unknown_axes(sub), "Y");
  EXPECT_EQ(unknown_axes("o9 sub\nG1 Y#1\no9 endsub\no9 call [#100]\n"), "Y");
  EXPECT_EQ(unknown_axes("o9 sub\no9 endsub [#100]\no9 call\nG1 X#<_value>\n"), "X");
}

TEST(Provenance, TheEndOfTheProgramInDoubtLosesNothing) {
  const std::string guard = "o1 if [#<_task> EQ 5]\nM2\no1 endif\n";
  EXPECT_EQ(unknown_axes(guard), "");
  EXPECT_THAT(seen(guard).lines, ElementsAre(2));
}

TEST(Provenance, APositionFollowsFromAbsoluteWordsAlone) {
  EXPECT_EQ(unknown_axes("G91\nG1 X1\nG90\n"), "");
  EXPECT_EQ(unknown_axes("G28\n"), "XYZ");
  EXPECT_EQ(unknown_axes("G38.2 Z-5\n"), "Z");
  EXPECT_EQ(unknown_axes("G43 H0\n"), "Z");
  EXPECT_EQ(unknown_axes("G55\n"), "XYZ");
  EXPECT_EQ(unknown_axes("G54\n"), "");
  EXPECT_EQ(unknown_axes("G92 X1\n"), "YZ");
  EXPECT_EQ(unknown_axes("G53 G0 Z0\n"), "Z");
  Config given;
  given.start_known = true;
  given.tools.emplace();
  EXPECT_EQ(unknown_axes("G55\nG53 G0 Z0\n", given), "");
}

TEST(Comments, ThoseThatLinuxCncExecutesAreRefusedWhereTheyAreReached) {
  EXPECT_EQ(seen("(abort, too deep)\n").refused, "abort");
  EXPECT_EQ(seen("G1 X1 ( ABORT,now)\n").refused, "abort");
  EXPECT_EQ(seen("o1 if [0]\n(abort, too deep)\no1 endif\n").refused, "");
  // LinuxCNC acts on the last comment of a line alone, and on none behind an O-word.
  EXPECT_EQ(seen("(abort, too deep) (really)\n").refused, "");
  EXPECT_EQ(seen("o1 if [1] (abort, too deep)\no1 endif\n").refused, "");
  EXPECT_EQ(seen("(abort later)\n(about, this)\n").refused, "");
  for (const char* python : {"(py,this.params[5]=45)", ";py,this.params[5]=45", "( PyRun,a.py)",
                             "(pyreload)", "G1 X1 (py,1) (really)"}) {
    EXPECT_EQ(seen(std::string(python) + "\n").refused, "python") << python;
  }
  EXPECT_EQ(seen("(MSG,a)\n(debug,#100)\n(print,x)\n(log,x)\n(logopen,x)\n(logclose)\n").refused,
            "");
  Config fanuc;
  fanuc.dialect = read::Dialect::fanuc;
  EXPECT_EQ(seen("(ABORT,NOW)\n", fanuc).refused, "");
}

TEST(Loops, WhatLinuxCncCountsOtherwiseIsRefused) {
  const std::string go_on =
      "#1=0\no1 do\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\no1 while [#1 LT 3]\n";
  const std::string leave =
      "#1=0\no1 while [#1 LT 3]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 break\no2 endif\no1 endwhile\n";
  const std::string repeat = "o3 repeat [3]\nG1 X1\no3 endrepeat\n";
  const std::string turns = "#1=0\no4 do\n#1=[#1+1]\no4 while [#1 LT 3]\n";
  const std::string once = "o5 do\no5 while [0]\n";
  const std::string ends = "o6 while [0]\no6 endwhile\n";
  EXPECT_EQ(seen(go_on + repeat).refused, "repeat_after_continue");
  EXPECT_EQ(seen(go_on + turns + repeat).refused, "repeat_after_continue");
  EXPECT_EQ(seen(leave + turns).refused, "loop_after_break");
  EXPECT_EQ(seen(leave + repeat + turns).refused, "loop_after_break");
  for (const std::string& fine : {go_on + turns, go_on + ends + repeat, leave + repeat,
                                  leave + once + turns, repeat + turns}) {
    EXPECT_EQ(seen(fine).refused, "") << fine;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
