// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/nc/rewrite/test/workshop.hpp>
#include <steadyrest/nc/rewrite/text/source_lines.hpp>
#include <steadyrest/nc/rewrite/walk/plain_survey.hpp>

namespace steadyrest::nc::rewrite::test {
namespace {

std::optional<Survey> plain(const std::string& path,
                            read::Dialect dialect = read::Dialect::linuxcnc) {
  PlainSurvey found(dialect);
  auto lines = SourceLines::open(path).value();
  while (lines.next()) {
    found.look(lines.line());
  }
  return found.take();
}

bool is_plain(const std::string& line) {
  PlainSurvey found(read::Dialect::linuxcnc);
  found.look(line);
  return found.take().has_value();
}

TEST(PlainSurvey, WhatMayRepeatOrBranchIsNotPlain) {
  // Near misses included: M97.9999 rounds to M98, G42.9999 to G43, Cyrillic О is not the letter O.
  for (const char* line : {"O100 sub",   "o<cut> call", "N10 O1 repeat [3]",
                           "M98 P100",   "m 9 8 P100",  "M99",
                           "M97 P1",     "M098P1",      "/G0 X1",
                           "#1=3",       "G#1",         "M[90+8]",
                           "G0 X[1+2]",  "M97.9999",    "M98.",
                           "G42.9999",   "M+98",        "M-98",
                           "M0098P1",    "(unclosed",   "M0000006",
                           "G",          "M",           "G1 E3",
                           "@",          "^",           "\"G0\"",
                           "G0 X1=2",    "{",           "\x01",
                           "G0 \xD0\x9E"}) {
    EXPECT_FALSE(is_plain(line)) << line;
  }
}

TEST(PlainSurvey, WordsOfALetterAndANumberArePlain) {
  // The same words in comments are only text.
  for (const char* line :
       {"", "%", "N10 G0 X-1.5 Y+2 Z.3", "g1x1y2 z 3 . 5f100", "M3 S1000 (O100 call) G54.1",
        "T1 M6 ; M98", "(o100 sub)", "G81 R1 Z-3 L4", "M30", "G43.1 Z1", "M61Q2", "G64 P0.01"}) {
    EXPECT_TRUE(is_plain(line)) << line;
  }
}

TEST(PlainSurvey, OtherDialectsAreRun) {
  for (const auto dialect : {read::Dialect::fanuc, read::Dialect::sinumerik}) {
    PlainSurvey found(dialect);
    found.look("G0 X1");
    EXPECT_FALSE(found.take().has_value());
  }
}

/// The survey by text may find more intervals without a length than the run, never fewer: too many
/// cost places, too few cost parts.
void expect_as_run(const std::string& path, const interpret::Config& config, int& compared) {
  const auto by_text = plain(path);
  const auto by_run = survey(path, config);
  if (!by_text || !by_run) {
    return;
  }
  ++compared;
  // Plain by its text, so the run must find nothing repeated or called.
  EXPECT_TRUE(by_run->repeated.empty()) << path;
  EXPECT_TRUE(by_run->subprogram_files.empty()) << path;
  EXPECT_GE(by_text->end_line, by_run->end_line) << path;
  for (std::uint64_t step = 0; step <= by_text->end_line; ++step) {
    const auto without = [step](const Survey& s) {
      return std::ranges::any_of(s.without_length, [step](const auto& interval) {
        return interval.first < step && step <= interval.second;
      });
    };
    ASSERT_TRUE(!without(*by_run) || without(*by_text)) << path << ":" << step;
  }
}

TEST(PlainSurvey, FindsTheToolChangesThatTheRunFinds) {
  const Workshop shop;
  const std::string path = shop.original();
  int compared = 0;
  for (const char* text :
       // Tool words in comments, spaced, in small letters, with M61, and intervals that never end.
       {"T1 M6\nG0 Z5\nG43 H1\nG0 X1\nT2 M6\nG0 X2\nG49\nG0 X3\nG43H2\nM2\n",
        "G43 H1 T1 M6\nG0 X1\n\n(M6)\nM06\nT2\nG0X2\ng 4 3.1 Z1\nG0 X3\nM61 Q3\nG0 X1\nG43\nM2\n",
        "%\nT1M6\n%\nG43\n", "M6 T1\nM6 T2\nG43\nG43\nM2\nG0 X1\n"}) {
    write_file(path, text);
    expect_as_run(path, shop.config, compared);
  }
  EXPECT_EQ(compared, 4);
}

TEST(PlainSurvey, AgreesWithTheRunOnRealPrograms) {
  const Workshop shop;
  int compared = 0;
  for (const std::string& folder : {(kernel::file::testing::shared_data() / "nc").string(),
                                    std::string{STEADYREST_SOURCE_DIR "/examples"},
                                    std::string{STEADYREST_SOURCE_DIR "/tests/accepted/nc"},
                                    std::string{"/usr/share/linuxcnc"}}) {
    std::error_code absent;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, absent)) {
      if (entry.is_regular_file() && entry.path().extension() != ".py") {
        expect_as_run(entry.path().string(), shop.config, compared);
      }
    }
  }
  EXPECT_GE(compared, 1);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite::test
