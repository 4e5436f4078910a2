// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/outcome/reason.hpp>

namespace steadyrest::kernel::outcome {
namespace {

const std::string kRoot = STEADYREST_SOURCE_DIR;

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(kRoot + path).rdbuf();
  return text.str();
}

/// The header's enumerators: name → number. Read from the header's text, since the compiler offers
/// no list of enumerators.
std::map<std::string, int> enumerators() {
  const std::string header = contents("/steadyrest/kernel/outcome/reason.hpp");
  const auto begin = header.find("enum class Reason");
  std::istringstream lines(header.substr(begin, header.find("};", begin) - begin));
  std::map<std::string, int> found;
  std::string name;
  std::string equals;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    if (std::istringstream words(line); words >> name >> equals >> number && equals == "=") {
      found[name] = number;
    }
  }
  return found;
}

struct Range {
  int first;
  const char* title;
};
constexpr Range kRanges[] = {{0, "Common"},    {100, "Envelope and arbiter"},
                             {200, "Motion"},  {300, "Contour"},
                             {400, "Chatter"}, {500, "Thermal"}};

std::string document() {
  std::string text =
      "# Reasons\n\nEvery request, command, log line and report carries one of these numbers. They "
      "are stable: a number\nis never given a second meaning. This page is written from the table "
      "in\n`steadyrest/kernel/outcome/reason.cpp`; `STEADYREST_REWRITE_DOCS=1 ctest -R Reason` "
      "rewrites it.\n";
  for (const auto& [first, title] : kRanges) {
    std::string rows;
    for (const auto& entry : reasons()) {
      const int number = static_cast<int>(entry.reason);
      if (number / 100 * 100 == first) {
        rows += fmt::format("| {} | `{}` | {} |\n", number, entry.name, entry.sentence);
      }
    }
    if (!rows.empty()) {
      text += fmt::format("\n## {}–{}: {}\n\n| number | name | meaning |\n|---|---|---|\n{}", first,
                          first + 99, title, rows);
    }
  }
  return text;
}

// Records of earlier versions carry the numbers; three of them are pinned here.
TEST(Reason, NumbersAreStable) {
  EXPECT_EQ(static_cast<int>(Reason::none), 0);
  EXPECT_EQ(static_cast<int>(Reason::panel_zero), 100);
  EXPECT_EQ(static_cast<int>(Reason::contour_limit), 300);
}

TEST(Reason, TheTableCoversEveryEnumeratorByItsOwnName) {
  const auto declared = enumerators();
  ASSERT_GE(declared.size(), 20U) << "the header was not understood";
  std::map<std::string, int> listed;
  for (const auto& entry : reasons()) {
    listed[std::string(entry.name)] = static_cast<int>(entry.reason);
  }
  EXPECT_EQ(declared, listed);
  EXPECT_EQ(reasons().size(), listed.size()) << "a name is in the table twice";
}

// In order and without duplicates, so that a number is quickly found in the table.
TEST(Reason, TheTableRisesAndEveryEntryHasASentence) {
  EXPECT_TRUE(std::ranges::is_sorted(reasons(), std::less_equal<>{}, &ReasonEntry::reason));
  for (const auto& entry : reasons()) {
    EXPECT_EQ(name(entry.reason), entry.name);
    EXPECT_EQ(sentence(entry.reason), entry.sentence);
    EXPECT_TRUE(entry.sentence.ends_with('.')) << entry.name;
    EXPECT_LT(static_cast<int>(entry.reason), 600) << entry.name;
  }
}

// A newer version's record may carry one.
TEST(Reason, ANumberWithoutEntryIsUnknown) {
  EXPECT_EQ(name(static_cast<Reason>(9999)), "unknown");
  EXPECT_EQ(sentence(static_cast<Reason>(9999)), "Unknown reason.");
}

// The page is generated; it must match the table.
TEST(Reason, TheDocumentIsWhatTheTableSays) {
  if (std::getenv("STEADYREST_REWRITE_DOCS") != nullptr) {
    std::ofstream(kRoot + "/docs/reasons.md") << document();
  }
  EXPECT_EQ(contents("/docs/reasons.md"), document())
      << "docs/reasons.md is out of date; run with STEADYREST_REWRITE_DOCS=1";
}

}  // namespace
}  // namespace steadyrest::kernel::outcome
