// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>

#include <steadyrest/nc/rewrite/test/workshop.hpp>

namespace steadyrest::nc::rewrite {
namespace {

using test::text_of_file;
using test::Workshop;

/// A program of passes with random line ends, comments and formats; comments may hold non-ASCII
/// bytes.
std::string random_program(std::mt19937& random) {
  const auto one_of = [&](auto... texts) {
    const std::string list[] = {texts...};
    return list[random() % sizeof...(texts)];
  };
  const std::string usual = one_of("\n", "\r\n");
  std::string text;
  const auto line = [&](const std::string& words) {
    const std::string note =
        one_of("", "", " (pass)", " (\xd1\x84\xe4\xff)", "  ; STEADY\xb5", " (STEADYREST)");
    text += one_of("", "", "N10 ", "  ") + words + note +
            (random() % 9 == 0 ? one_of("\n", "\r\n") : usual);
    if (random() % 7 == 0) {
      text += one_of("", " ", "(only a comment)", ";") + usual;
    }
  };
  const bool percent = random() % 2 == 0;
  if (percent) {
    text += "%" + usual;
  }
  line("G21 G90 G94 G17 G54");
  line("G0 X0 Y0 Z20");
  for (int pass = 0; pass < 6; ++pass) {
    line("G0 Z5");
    line("G0 X0 Y" + std::to_string(pass));
    line(one_of("G0 Z2.5", "G00 Z1", "g0z2"));
    line(one_of("G1 Z-1 F600", "G1 Z-.5 F500"));
    line(one_of("G1 X100 F200", "G2 X100 I50 F200", "X100 F200"));
  }
  line("G0 Z20");
  text += percent && random() % 2 == 0 ? "%" : one_of("M2", "M30");
  text += one_of("", "\n", "\r\n", "\r\nbehind the end");
  return text;
}

RC_GTEST_PROP(Strip, RestoresEveryProgramByteForByte, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  Workshop shop;
  // 50 ms periods make the timing fast; strip does not depend on it.
  shop.machine.control.interpolator_period_s = 0.05;
  const std::string program = random_program(random);
  const double first = 20.0 + static_cast<double>(random() % 100);
  const double delta = static_cast<double>(random() % 200) / 7.0 - 14.0;
  // The program's own time first: the plan must fit.
  // 40000 minutes fit no program: the refusal reveals the program's own time.
  const auto unknown =
      shop.compensate(program, R"({"transitions": [{"n": 1, "t_min": [40000], "delta_um": [0]}]})");
  RC_ASSERT(!unknown);
  const std::string& what = unknown.error().what;
  const auto at = what.find("program takes ");
  RC_ASSERT(at != std::string::npos);
  const double total_s = std::stod(what.substr(at + 14));
  const auto minutes = [](double s) { return std::to_string(s / 60.0); };
  const std::string plan = R"({"transitions": [{"n": 3, "t_min": [)" + minutes(first) + ", " +
                           minutes(30.0) + ", " + minutes(total_s - first - 30.0) +
                           R"(], "delta_um": [0, )" + std::to_string(delta) + ", 3.3]}]}";
  const auto done = shop.compensate(program, plan);
  RC_ASSERT(done.has_value());
  RC_ASSERT(done->inserted_lines > 0U);
  RC_ASSERT(strip(shop.changed(), shop.changed()).value() == done->inserted_lines);
  RC_ASSERT(text_of_file(shop.changed()) == program);
}

TEST(Strip, LeavesOtherCommentsAlone) {
  const Workshop shop;
  // STEADYREST without a blank and words after it, or not at the start of a comment: the user's
  // own.
  const std::string program = "(STEADYREST)\n(made for STEADYREST 1)\n;a STEADYREST b\nM2";
  test::write_file(shop.original(), program);
  EXPECT_EQ(strip(shop.original(), shop.changed()).value(), 0U);
  EXPECT_EQ(text_of_file(shop.changed()), program);
}

/// Lines with the mark that an author may have written; the last ones differ from what compensate()
/// writes only by a number, a blank or an axis.
const std::string kOwnLines[] = {
    "G1 X1 F10 (STEADYREST is on this machine)",
    "(STEADYREST is on this machine)",
    "; G0 Z5 ;STEADYREST restated",
    "G0 Z5 X1 (STEADYREST restated)",
    "G0 Z5.0000 (STEADYREST restated) M30",
    "G1 Z5.0000 (STEADYREST restated)",
    "G02 Z5.0000 (STEADYREST restated)",
    "M30 (STEADYREST head Z)",
    "G91 G10 L20 P0 Z-0.0100 (STEADYREST Z-0.0100 mm)",
    "G90 G10 L2 P1 Z0.0000 X1 (STEADYREST head Z)",
    "(STEADYREST head told --dialect linuxcnc) G1 X1",
    "(STEADYREST head told us to) G0 X1",
    "M0 (STEADYREST head of the coolant)",
    "R50=R51 ;STEADYREST head Z",
    "STOPRE STOPRE ;STEADYREST Z0.0100 mm",
    "(MSG,STEADYREST is on this machine)",
};

TEST(Strip, RefusesALineThatCompensateDoesNotWriteWithItsLine) {
  const Workshop shop;
  for (const std::string& own : kOwnLines) {
    // With a head, so that a missing head is not the reason.
    const std::string program = "(STEADYREST head told --window-s 60)\n" + own + "\nM2\n";
    test::write_file(shop.original(), program);
    const auto stripped = strip(shop.original(), shop.changed());
    ASSERT_FALSE(stripped) << own;
    EXPECT_EQ(stripped.error().kind, kernel::outcome::Kind::bad_input);
    EXPECT_EQ(stripped.error().line, 2U) << own;
    EXPECT_FALSE(std::filesystem::exists(shop.changed())) << own;
  }
}

// What compensate() would write, in a program that it did not write.
TEST(Strip, RefusesCorrectionsWithoutAHead) {
  const Workshop shop;
  for (const std::string& line :
       {std::string{"G0 Z5.0000 (STEADYREST restated)\n"}, test::change_to(0.01)}) {
    test::write_file(shop.original(), "G21\n" + line + "M2\n");
    const auto stripped = strip(shop.original(), shop.changed());
    ASSERT_FALSE(stripped) << line;
    EXPECT_EQ(stripped.error().line, 2U);
    EXPECT_FALSE(std::filesystem::exists(shop.changed()));
  }
}

// Any line of the author's own in a corrected program: nothing is removed.
RC_GTEST_PROP(Strip, TakesNoLineThatCompensateDidNotInsert, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  Workshop shop;
  shop.machine.control.interpolator_period_s = 0.05;
  shop.settings.told = {{"dialect", "linuxcnc"}, {"window-s", "60"}};
  RC_ASSERT(shop.compensate(test::kPasses, test::kGrowth).has_value());
  std::string text = text_of_file(shop.changed());
  auto at = text.find('\n', random() % (text.size() - 1)) + 1;
  const std::string& own = kOwnLines[random() % std::size(kOwnLines)];
  const bool apart = random() % 2 == 0;
  text.insert(at, own + "\n");
  // Or the author changed an inserted line: an extra word before its mark.
  if (apart) {
    text.erase(at, own.size() + 1);
    const auto mark = text.find(" (STEADYREST", at);
    if (mark == std::string::npos) {
      return;
    }
    at = mark;
    text.insert(mark, " X1");
  }
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  test::write_file(shop.original(), text);
  std::filesystem::remove(shop.changed());
  const auto stripped = strip(shop.original(), shop.changed());
  RC_ASSERT(!stripped.has_value());
  RC_ASSERT(stripped.error().line == static_cast<std::size_t>(line));
  RC_ASSERT(!std::filesystem::exists(shop.changed()));
}

TEST(Strip, RefusesATargetThatIsAFolder) {
  const Workshop shop;
  test::write_file(shop.original(), "M2\n");
  EXPECT_FALSE(strip(shop.original(), shop.folder()));
  EXPECT_FALSE(strip(shop.original(), shop.folder() + "/none/changed.nc"));
  EXPECT_FALSE(strip(shop.folder() + "/none.nc", shop.changed()));
  EXPECT_FALSE(std::filesystem::exists(shop.changed()));
}

// A file size limit acts as a full disk.
TEST(Strip, ADiskThatTakesNoMoreLeavesTheOldFile) {
  const Workshop shop;
  test::write_file(shop.original(), std::string(50'000, '\n') + "M2\n");
  test::write_file(shop.changed(), "old");
  ::rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const ::rlimit small = {.rlim_cur = 4096, .rlim_max = before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto refused = strip(shop.original(), shop.changed());
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, kernel::outcome::Kind::unavailable);
  EXPECT_EQ(text_of_file(shop.changed()), "old");
  const auto files = std::filesystem::directory_iterator(shop.folder());
  EXPECT_EQ(std::distance(begin(files), end(files)), 2);
}

}  // namespace
}  // namespace steadyrest::nc::rewrite
