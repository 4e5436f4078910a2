// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/nc/plan/path/plan_program.hpp>
#include <steadyrest/nc/rewrite/original/original_path.hpp>
#include <steadyrest/nc/rewrite/replace/replace.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using read::Dialect;
using test::replaced;
using test::text_of_file;
using test::Workshop;
using test::write_file;
using testing::HasSubstr;

/// Four cuts round a square; the third is commanded 0.1 mm outside, from line 5 on.
const std::string kSquare =
    "G17 G21 G90 G94 G54\nG0 X0 Y0\nG1 X20 F600\nY20\nX0\nY0\nG0 Z20\nM30\n";
const NewLines kOutside = {{5, {"G1 X19.9 Y20.1 F600", "G1 X0.1 Y20.1", "G1 X0.0 Y20.0"}}};

std::vector<Told> told(const std::string& changes) {
  return {{"changes", changes}, {"tube-mm", "0.2"}};
}

/// The square with its third cut changed.
struct Square : Workshop {
  explicit Square(Dialect dialect = Dialect::linuxcnc, const std::string& changes = "predistort") {
    config.dialect = dialect;
    text = dialect == Dialect::sinumerik ? replaced(kSquare, "G21", "G71") : kSquare;
    write_file(original(), text);
    write_file(changed(), replace(original(), dialect, kOutside, told(changes)).value().text);
  }
  /// The planned path of the changed program, completed from its marks.
  [[nodiscard]] plan::PlannedPath path(const std::vector<std::string>& called = {}) const {
    auto path = plan::plan_file(changed(), config, machine).value();
    hold_against_original(read_text_marks(changed(), called), changed(), config, machine, path);
    return path;
  }
  /// The same with something in its text changed.
  [[nodiscard]] plan::PlannedPath edited(const std::string& from, const std::string& to) const {
    write_file(changed(), replaced(text_of_file(changed()), from, to));
    return path();
  }
  std::string text;
};

TEST(OriginalPath, IsThatOfTheProgramBeforeInEveryDialect) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik}) {
    const Square square(dialect);
    const auto path = square.path();
    ASSERT_TRUE(path.original) << path.original_unknown;
    EXPECT_EQ(path.original_unknown, "");
    const auto before = plan::plan_file(square.original(), square.config, square.machine).value();
    ASSERT_EQ(path.original->segments.size(), before.segments.size());
    for (std::size_t i = 0; i < before.segments.size(); ++i) {
      EXPECT_EQ(path.original->segments[i].end_mm, before.segments[i].end_mm);
    }
  }
}

TEST(OriginalPath, NamesTheSegmentsThatTheTextMovesAndTheirPlaces) {
  const auto path = Square().path();
  ASSERT_TRUE(path.original);
  double before_mm = 0.0;
  for (const auto& segment : path.segments) {
    const bool moved = segment.motion == kernel::signal::Motion::feed &&
                       (segment.start_mm[1] > 20.05 || segment.end_mm[1] > 20.05);
    EXPECT_EQ(segment.by_text, moved) << segment.line;
    EXPECT_NEAR(segment.original_start_mm, before_mm, 1e-9);
    before_mm = segment.original_end_mm;
    // Sideways alone: the place is that of the same X or Y.
    EXPECT_NEAR(segment.original_end_mm, segment.position_mm + segment.length_mm, 0.3);
  }
  const auto& last = path.original->segments.back();
  EXPECT_NEAR(before_mm, last.position_mm + last.length_mm, 1e-9);
}

TEST(OriginalPath, ThereIsNoneWhereTheTextCorrectsNoPath) {
  const Workshop shop;
  write_file(shop.changed(), kSquare);
  EXPECT_FALSE(read_text_marks(shop.changed()).path);
  write_file(shop.original(), kSquare);
  write_file(shop.changed(), replace(shop.original(), Dialect::linuxcnc,
                                     {{4, {"G1 Y20 F300.0"}}, {5, {"X0 F600.0"}}}, told("feeds"))
                                 .value()
                                 .text);
  const TextMarks marks = read_text_marks(shop.changed());
  EXPECT_FALSE(marks.path);
  EXPECT_FALSE(marks.heat);
  EXPECT_EQ(marks.unknown, "");
}

TEST(OriginalPath, IsUnknownWhereTheMarksAreDamaged) {
  const std::string head = "(STEADYREST head made ";
  struct Case {
    std::string from;
    std::string to;
    std::string why;
  };
  for (const Case& one : {
           Case{"--tube-mm 0.2", "--tube-mm 0.3", "missing or changed"},
           Case{head, "(STEADYFAST head made ", "missing or changed"},
           Case{"was 3 ", "was 4 ", "fewer new lines than it says"},
           Case{"was 3 ", "was 2 ", "belongs to no replaced one"},
           Case{"G1 X0.1 Y20.1 ;STEADYREST new\n", "", "fewer new lines than it says"},
           Case{";STEADYREST was 3 X0\n", "", "belongs to no replaced one"},
           // Edited by hand, within the tube and beyond it.
           Case{"was 3 X0", "was 3 X0.01", "were edited after it was made"},
           Case{"G1 X0.1 Y20.1 ;", "G1 X0.1 Y20.15 ;", "were edited after it was made"},
       }) {
    const auto path = Square().edited(one.from, one.to);
    EXPECT_FALSE(path.original) << one.to;
    EXPECT_THAT(path.original_unknown, HasSubstr(one.why)) << one.to;
    ASSERT_EQ(words_of(path).size(), 1U);
    EXPECT_THAT(words_of(path)[0], HasSubstr("the layer stays out of the contour"));
  }
}

// A line that stays belongs to both programs.
TEST(OriginalPath, GoesWithAnEditOfALineThatStays) {
  const auto path = Square().edited("G0 Z20", "G0 Z30");
  ASSERT_TRUE(path.original) << path.original_unknown;
  EXPECT_EQ(path.original->segments.back().end_mm[2], 30.0);
}

TEST(OriginalPath, AControlMayChangeBlanksLettersAndLineEnds) {
  const Square square;
  std::string text = text_of_file(square.changed());
  for (const auto& [from, to] :
       {std::pair("G1 X0.1 Y20.1 ;", "g1x0.1y20.1 ;"), std::pair("was 3 X0\n", "was 3 X0\r\n")}) {
    text = replaced(std::move(text), from, to);
  }
  write_file(square.changed(), text);
  EXPECT_TRUE(square.path().original) << square.path().original_unknown;
}

std::string mapped(std::string text, int (*letter)(int)) {
  std::ranges::transform(text, text.begin(),
                         [letter](unsigned char c) { return static_cast<char>(letter(c)); });
  return text;
}

// Nothing of such a program may look like one without marks.
TEST(OriginalPath, IsUnknownWhereAControlHasChangedTheMarks) {
  for (const Dialect dialect : {Dialect::linuxcnc, Dialect::fanuc, Dialect::sinumerik}) {
    const Square square(dialect);
    const std::string text = text_of_file(square.changed());
    std::string bare = text;
    std::erase(bare, ' ');
    std::string numbered;
    for (std::size_t at = 0, n = 10; at < text.size(); at = text.find('\n', at) + 1, n += 10) {
      numbered += "N" + std::to_string(n) + " " + text.substr(at, text.find('\n', at) - at + 1);
    }
    for (const std::string& changed :
         {mapped(text, std::toupper), mapped(text, std::tolower), bare, numbered}) {
      write_file(square.changed(), changed);
      const TextMarks marks = read_text_marks(square.changed());
      EXPECT_TRUE(marks.path) << changed;
      EXPECT_NE(marks.unknown, "") << changed;
      EXPECT_FALSE(strip(square.changed(), square.folder() + "/out.nc")) << changed;
    }
  }
}

// A block in two: the control rounds the corner at its end by less, and the tube is smaller than
// that.
TEST(OriginalPath, IsKnownWhereTheControlRoundsACornerOtherwise) {
  Workshop shop;
  shop.config.dialect = Dialect::linuxcnc;
  write_file(shop.original(), "G17 G21 G90 G94 G54 G64 P2\nG1 X20 F4000\nY20\nM2\n");
  write_file(shop.changed(),
             replace(shop.original(), Dialect::linuxcnc, {{2, {"G1 X19.5 F4000.0", "G1 X20.0"}}},
                     {{"changes", "predistort,feeds"}, {"tube-mm", "0.02"}})
                 .value()
                 .text);
  auto path = plan::plan_file(shop.changed(), shop.config, shop.machine).value();
  hold_against_original(read_text_marks(shop.changed()), shop.changed(), shop.config, shop.machine,
                        path);
  ASSERT_TRUE(path.original) << path.original_unknown;
  EXPECT_TRUE(std::ranges::any_of(path.segments, &kernel::signal::PathSegment::by_text));
}

TEST(OriginalPath, AUsersOwnCommentIsNoMark) {
  const Workshop shop;
  write_file(shop.changed(),
             "(steadyrest new position)\nG21 G1 X1 F100 (STEADYREST WAS OPEN)\nM2\n");
  const TextMarks marks = read_text_marks(shop.changed());
  EXPECT_FALSE(marks.path);
  EXPECT_EQ(marks.unknown, "");
}

// Programs of earlier versions have no sum over their blocks; there the tube finds what it can.
TEST(OriginalPath, OfAnEarlierVersionIsUnknownBeyondTheTube) {
  const auto earlier = [](const std::string& from, const std::string& to) {
    const Square square;
    std::string text = text_of_file(square.changed());
    text.replace(0, text.find('\n') + 1,
                 mark_text({.method = Method::linuxcnc}, told("predistort"), "\n", kReplacedMark));
    write_file(square.changed(), replaced(text, from, to));
    return square.path();
  };
  EXPECT_TRUE(earlier("G0 X0", "G0 X0").original);
  EXPECT_THAT(earlier("was 3 X0", "was 3 X5").original_unknown,
              HasSubstr("from the original that its marks hold; they allow 0.2 mm"));
  EXPECT_THAT(earlier("G1 X0.1 Y20.1 ;", "G1 X0.1 Y21.0 ;").original_unknown,
              HasSubstr("from the original that its marks hold"));
  EXPECT_THAT(earlier("was 3 X0", "was 3 X0 G999").original_unknown, HasSubstr("the original of "));
}

TEST(OriginalPath, IsUnknownForAChangeOfALaterVersion) {
  const auto path = Square(Dialect::linuxcnc, "predistort,smooth").path();
  EXPECT_THAT(path.original_unknown, HasSubstr("--changes smooth, which is not known"));
}

TEST(OriginalPath, IsUnknownWhereACalledFileIsCorrected) {
  const Square square;
  write_file(square.original(), square.text);  // calls itself nothing
  Square called;
  const auto marks = read_text_marks(square.original(), {called.changed()});
  EXPECT_TRUE(marks.path);
  EXPECT_THAT(marks.unknown, HasSubstr("which it calls, has blocks replaced"));
  EXPECT_EQ(read_text_marks(square.original(), {called.original()}).unknown, "");
}

TEST(OriginalPath, KeepsTheCorrectionsOfAPlan) {
  Workshop shop;
  ASSERT_TRUE(shop.compensate(test::kPasses, test::kGrowth));
  const TextMarks marks = read_text_marks(shop.changed());
  EXPECT_TRUE(marks.heat);
  EXPECT_FALSE(marks.path);
  // With blocks replaced as well, the original still has them.
  const std::string compensated = text_of_file(shop.changed());
  write_file(shop.original(), compensated);
  const auto lines = static_cast<std::uint32_t>(
      std::ranges::count(compensated.substr(0, compensated.find("G2 X20")), '\n'));
  const auto both =
      replace(shop.original(), Dialect::linuxcnc,
              {{lines + 1, {"G2 X20.0 Y20.0 I10.0 J0.0 F100.0"}}}, told("predistort"));
  write_file(shop.changed(), both.value().text);
  const TextMarks both_marks = read_text_marks(shop.changed());
  EXPECT_TRUE(both_marks.heat);
  EXPECT_EQ(both_marks.original, compensated);
}

TEST(OriginalPath, AnAlteredRecordOfAPlanStillSaysThatHeatIsCorrected) {
  Workshop shop;
  shop.settings.told = {{"dialect", "linuxcnc"}};
  ASSERT_TRUE(shop.compensate(test::kPasses, test::kGrowth));
  write_file(shop.changed(), replaced(text_of_file(shop.changed()), "--sum ", "--sum 0"));
  EXPECT_TRUE(read_text_marks(shop.changed()).heat);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
