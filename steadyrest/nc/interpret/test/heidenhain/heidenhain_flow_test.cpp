// SPDX-License-Identifier: Apache-2.0
// Labels, repeats, jumps, called programs and Q parameters of Klartext.
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <steadyrest/nc/interpret/test/heidenhain/heidenhain.hpp>

namespace steadyrest::nc::interpret {
namespace {

using test::heidenhain;
using test::klartext;
using test::klartext_ends;
using test::klartext_reason;
using testing::ElementsAre;
using testing::IsEmpty;

/// A folder of programs, gone at the end.
class ProgramFolder {
 public:
  ProgramFolder() { std::filesystem::create_directory(path_); }
  ProgramFolder(const ProgramFolder&) = delete;
  ProgramFolder& operator=(const ProgramFolder&) = delete;
  ~ProgramFolder() { std::filesystem::remove_all(path_); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  [[nodiscard]] Config config() const {
    Config config = heidenhain();
    config.subprogram_folders = {path_.string()};
    return config;
  }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("nc-klartext-" + std::to_string(::getpid()));
};

// "Program section repeats": the section runs once more than REP says. LBL 0 within it is passed.
TEST(HeidenhainFlow, RepeatsSections) {
  EXPECT_THAT(klartext_ends(0, "LBL 1\nL IX+10 FMAX\nCALL LBL 1 REP 2/2\nL X+99 FMAX"),
              ElementsAre(10, 20, 30, 99));
  EXPECT_THAT(klartext_ends(0, "LBL 2\nL IX+1 FMAX\nLBL 0\nCALL LBL 2 REP 1\nM30"),
              ElementsAre(1, 2));
  // Nested: the inner repeats start over with each outer one.
  EXPECT_THAT(klartext_ends(0,
                            "LBL 1\nL IX+10 FMAX\nLBL 2\nL IX+1 FMAX\nCALL LBL 2 REP 1\n"
                            "CALL LBL 1 REP 1"),
              ElementsAre(10, 11, 12, 22, 23, 24));
}

TEST(HeidenhainFlow, CallsSubprograms) {
  EXPECT_THAT(klartext_ends(0,
                            "CALL LBL 1\nCALL LBL \"TWO\" REP\nM30\nLBL 1\nL X+1 FMAX\nCALL LBL "
                            "\"TWO\"\nL X+3 FMAX\nLBL 0\nLBL \"TWO\"\nL X+2 FMAX\nLBL 0"),
              ElementsAre(1, 2, 3, 2));
  EXPECT_EQ(klartext_reason("CALL LBL 5"), "no_such_label");
  EXPECT_EQ(klartext_reason("CALL LBL 0"), "bad_label");
  EXPECT_EQ(klartext_reason("LBL 1\nL X+1 FMAX\nLBL 1\nCALL LBL 1"), "label_twice");
  EXPECT_EQ(klartext_reason("LBL 1\nCALL LBL 1\nLBL 0"), "calls_too_deep");
  EXPECT_EQ(klartext_reason("CALL LBL 1\nM30\nLBL 1\nL X+1 FMAX"), "subprogram_end");
}

TEST(HeidenhainFlow, Jumps) {
  EXPECT_THAT(klartext_ends(0,
                            "Q1 = 0\nLBL 1\nQ1 = Q1 + 1\nL X+Q1 FMAX\nFN 12: IF +Q1 LT +3 GOTO LBL "
                            "1\nFN 9: IF +Q1 EQU +3 GOTO LBL \"END\"\nL X+99 FMAX\nLBL \"END\""),
              ElementsAre(1, 2, 3));
  Config config = heidenhain();
  config.most_repeated_lines = 1000;
  EXPECT_EQ(reason_of(klartext("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1"), config), "endless_program");
  EXPECT_EQ(klartext_reason("Q1 = 1\nFN 10: IF +Q1 NE +1.0000000001 GOTO LBL 1\nLBL 1"),
            "comparison_too_close");
}

TEST(HeidenhainFlow, CallsPrograms) {
  const ProgramFolder folder;
  folder.write("HOLES.H",
               "BEGIN PGM HOLES MM\nQL1 = 5\nQ5 = Q5 + 1\nL X+Q5 Y+QL1 FMAX\nLBL 1\nL IX+1 FMAX\n"
               "CALL LBL 1 REP 1\nEND PGM HOLES MM\n");
  folder.write("ends.h", "BEGIN PGM ENDS MM\nM30\nEND PGM ENDS MM\n");
  folder.write("INCH.H", "BEGIN PGM INCH INCH\nEND PGM INCH INCH\n");
  const std::string text =
      "QL1 = 7\nQ5 = 1\nCALL PGM TNC:\\PARTS\\HOLES.H\nL Y+QL1 FMAX\nCALL PGM HOLES";
  EXPECT_THAT(ends_along(0, klartext(text), folder.config()), ElementsAre(2, 3, 4, 4, 3, 4, 5));
  EXPECT_THAT(ends_along(1, klartext(text), folder.config()), ElementsAre(5, 5, 5, 7, 5, 5, 5));
  EXPECT_EQ(reason_of(klartext("CALL PGM ENDS"), folder.config()), "subprogram_end");
  EXPECT_EQ(reason_of(klartext("CALL PGM INCH"), folder.config()), "unit_change");
  EXPECT_EQ(reason_of(klartext("CALL PGM NONE"), folder.config()), "no_such_program");
}

TEST(HeidenhainFlow, EndsWithItsLastLine) {
  EXPECT_EQ(reason_of("BEGIN PGM A MM\nL X+1 FMAX\n", heidenhain()), "no_program_end");
  EXPECT_EQ(reason_of("BEGIN PGM A MM\nL X+1 FMAX\nEND PGM A MM\nL X+2 FMAX\n", heidenhain()), "");
}

// After a refusal the rest is only looked through: what depends on values or on blocks that were
// not executed is no further fault.
TEST(HeidenhainFlow, ListsFurtherUnknownWords) {
  Kept kept;
  const auto report = run_text(
      klartext("PATTERN DEF ~\nPOS1( X+1 )\nQ5 = 1\nL X+Q5 RL\nCC X+0 Y+0\nC X+1 DR+\nCT X+5\n"
               "CYCL DEF 200 D ~\nQ200=Q7\nM77\nL X+1 RR"),
      heidenhain(), kept);
  std::vector<std::string> reasons;
  for (const auto& refused : report->refused) {
    reasons.push_back(refused.reason);
  }
  EXPECT_THAT(reasons, ElementsAre("pattern", "continued_block", "unknown_m_code", "cutter_comp"));
}

// Random jumps and repeats against a walk over the same blocks that knows nothing of lines.
TEST(HeidenhainFlow, FollowsRandomPrograms) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::mt19937 random(seed);
    // Sections one behind the other, each with a counter; some are called again from the end.
    const int sections = 1 + static_cast<int>(random() % 5);
    std::string text;
    std::vector<double> wanted;
    double x = 0;
    for (int i = 1; i <= sections; ++i) {
      const int repeats = static_cast<int>(random() % 4);
      const double step = 1 + static_cast<double>(random() % 9);
      const bool jumps = random() % 2 == 0;
      text += fmt::format("Q{} = 0\nLBL {}\nL IX+{} FMAX\n", i, i, step);
      text += jumps ? fmt::format("Q{0} = Q{0} + 1\nFN 12: IF +Q{0} LT +{1} GOTO LBL {2}\n", i,
                                  repeats + 1, i)
                    : fmt::format("CALL LBL {} REP {}\n", i, repeats);
      for (int k = 0; k <= repeats; ++k) {
        wanted.push_back(x += step);
      }
    }
    EXPECT_EQ(klartext_ends(0, text), wanted) << text;
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
