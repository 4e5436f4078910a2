// SPDX-License-Identifier: Apache-2.0
#include "rules.hpp"

#include <string>
#include <vector>

#include "sources_in_memory.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Each rule by the smallest tree that breaks it and the nearest one that does not. Violations are
// compared as rule:line, so a rule that fires in the wrong place also fails.
namespace house {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// 15 pairs of header and source are 15 files; tests count in their own folder.
TEST(Crowded, AFolderHoldsNoMoreThanOneCanLookThrough) {
  std::vector<SourceFile> tree;
  for (char c = 'a'; c < 'a' + 15; ++c) {
    for (const char* ending : {".hpp", ".cpp"}) {
      tree.push_back({std::string("steadyrest/nc/") + c + ending, ""});
    }
  }
  EXPECT_THAT(check_crowded(tree, rules()), IsEmpty());
  tree.push_back({"steadyrest/nc/test/z_test.cpp", ""});
  EXPECT_THAT(check_crowded(tree, rules()), IsEmpty());
  tree.push_back({"steadyrest/nc/z.hpp", ""});
  ASSERT_EQ(check_crowded(tree, rules()).size(), 1U);
  EXPECT_EQ(check_crowded(tree, rules()).front().path, "steadyrest/nc");
}

TEST(LongFile, IsFoundAtItsFirstLineTooMany) {
  const auto of_lines = [](const std::string& path, int lines) {
    std::string text = std::string(kSpdx) + "namespace steadyrest::nc {}\n";
    for (int i = 2; i < lines; ++i) {
      text += "// a line\n";
    }
    return found({path, text});
  };
  for (const std::string path :
       {"steadyrest/nc/x.cpp", "steadyrest/nc/x.hpp", "web/src/x.ts", "scripts/x.py"}) {
    EXPECT_THAT(of_lines(path, 400), IsEmpty()) << path;
    EXPECT_THAT(of_lines(path, 401), ElementsAre("long-file:401")) << path;
  }
  EXPECT_THAT(of_lines("web/test/x.mjs", 500), IsEmpty());
}

// The same header is fine in offline/ and in tests.
TEST(InCycle, HeadersOfLocksStreamsAndClocksAreRefused) {
  for (const std::string header :
       {"mutex", "iostream", "chrono", "fmt/ostream.h", "sys/time.h", "map"}) {
    EXPECT_THAT(found("steadyrest/contour/online/x.cpp", "#include <" + header + ">"),
                ElementsAre("in-cycle:2"))
        << header;
    EXPECT_THAT(found("steadyrest/contour/offline/x.cpp", "#include <" + header + ">"), IsEmpty());
    EXPECT_THAT(found("steadyrest/contour/online/test/x.cpp", "#include <" + header + ">"),
                IsEmpty());
  }
}

TEST(InCycle, AllocationAndThrowingAreRefused) {
  const std::string path = "steadyrest/motion/online/x.cpp";
  EXPECT_THAT(found(path, "int* p = new int;"), ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "void* p = std::malloc(3);"), ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "void f() { throw 1; }"), ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "std::lock_guard g(m);"), ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "auto t = std::chrono::steady_clock::now();"), ElementsAre("in-cycle:2"));
}

TEST(InCycle, TheSupervisorAndTheEnvelopeRunInTheCycleToo) {
  for (const std::string folder : {"supervisor", "kernel/override", "kernel/rt", "kernel/signal"}) {
    EXPECT_THAT(found("steadyrest/" + folder + "/x.cpp", "#include <mutex>"),
                ElementsAre("in-cycle:2"));
    EXPECT_THAT(found("steadyrest/" + folder + "/testing/x.cpp", "#include <mutex>"), IsEmpty());
  }
  EXPECT_THAT(found("steadyrest/kernel/machine/x.cpp", "#include <map>"), IsEmpty());
}

// `renew`, 1'000, a literal and a comment contain or look like a forbidden word.
TEST(InCycle, WordsInCommentsNamesAndLiteralsDoNotCount) {
  const std::string path = "steadyrest/motion/online/x.cpp";
  EXPECT_THAT(
      found(path, "// a new value\nint renew = 1'000; const char* s = \"new\"; char c = 'n';"),
      IsEmpty());
  EXPECT_THAT(found(path, "#include <new>"), IsEmpty());
  EXPECT_THAT(found(path, "X(const X&) = delete;"), IsEmpty());
}

TEST(InCycle, LoopsWithoutABoundAreRefused) {
  const std::string path = "steadyrest/motion/online/x.cpp";
  EXPECT_THAT(found(path, "void f() { while (true) {} }"), ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "void f() {\n  for ( ; ; ) {}\n}"), ElementsAre("in-cycle:3"));
  EXPECT_THAT(found(path, "void f() { for (int i = 0; i < 9; ++i) {} }"), IsEmpty());
}

// Declarations must say noexcept; calls are not declarations.
TEST(InCycle, UpdateMustBeNoexcept) {
  const std::string path = "steadyrest/motion/online/x.hpp";
  EXPECT_THAT(found(path, "class X { Output update(const Input& i); };"),
              ElementsAre("in-cycle:2"));
  EXPECT_THAT(found(path, "class X { Output update(const Input& i) noexcept; };"), IsEmpty());
  EXPECT_THAT(found(path, "class X { Output f() { return update(1); } };"), IsEmpty());
  EXPECT_THAT(found(path, "class X { void f() { filter_.update(1); } };"), IsEmpty());
}

TEST(Namespaces, FollowTheFolder) {
  const std::string text(kSpdx);
  EXPECT_THAT(found({"steadyrest/nc/read/x.hpp", text + "namespace steadyrest::nc {}\n"}),
              ElementsAre("namespace:2", "namespace:1"));
  EXPECT_THAT(found({"steadyrest/nc/read/x.hpp", text + "int a;\n"}), ElementsAre("namespace:1"));
  EXPECT_THAT(
      found({"steadyrest/nc/read/x.hpp", text + "namespace steadyrest::nc::read::detail {}\n"}),
      IsEmpty());
  EXPECT_THAT(
      found({"steadyrest/nc/read/test/x_test.cpp", text + "namespace steadyrest::nc::read {}\n"}),
      IsEmpty());
  EXPECT_THAT(found({"steadyrest/nc/read/test/words/x_test.cpp",
                     text + "namespace steadyrest::nc::read {}\n"}),
              IsEmpty());
  EXPECT_THAT(found({"steadyrest/apps/cli/main.cpp", text + "int main() {}\n"}), IsEmpty());
}

// The licence line opens every file, whatever its comment sign; in scripts it follows #!.
TEST(Spdx, OpensEveryFile) {
  EXPECT_THAT(found({"tests/x.cpp", "int a;\n"}), ElementsAre("spdx:1"));
  EXPECT_THAT(found({"scripts/x.sh", "#!/bin/sh\n# SPDX-License-Identifier: Apache-2.0\n"}),
              IsEmpty());
  EXPECT_THAT(found({"scripts/x.sh", "#!/bin/sh\necho\n"}), ElementsAre("spdx:1"));
  EXPECT_THAT(found({"steadyrest/x/CMakeLists.txt", ""}), ElementsAre("spdx:1"));
}

TEST(SharedData, AreFoundWithoutAVariable) {
  const std::string text =
      std::string(kSpdx) + "const char* set = std::getenv(\"STEADYREST_SHARED_DATA\");\n";
  EXPECT_THAT(found({"tests/x.cpp", text}), ElementsAre("shared-data:2"));
  EXPECT_THAT(found({"tests/x.cpp", text + "std::string other = \"/../shared/data\";\n"}),
              IsEmpty());
}

TEST(Built, ASourceThatNoListNamesIsFound) {
  const SourceFile source = file("steadyrest/nc/read/x.cpp", "");
  const SourceFile list{"steadyrest/nc/CMakeLists.txt", "# SPDX…\n  read/x.cpp\n"};
  EXPECT_THAT(check_built({source, list}, rules()), IsEmpty());
  const auto violations = check_built({source}, rules());
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_EQ(violations[0].rule, "unbuilt");
}

/// Violations of a class in the cycle that the supervisor holds as a member.
std::vector<std::string> held(const std::string& member, const std::string& body) {
  const auto violations = check_stages(
      {file("steadyrest/supervisor/layer.hpp", "struct Layer {\n  " + member + "\n};"),
       file("steadyrest/contour/online/governor.hpp", "class Governor {\n" + body + "\n};")},
      rules());
  std::vector<std::string> what;
  for (const Violation& violation : violations) {
    EXPECT_EQ(violation.rule, "stage");
    EXPECT_EQ(violation.path, "steadyrest/contour/online/governor.hpp");
    what.push_back(violation.what);
  }
  return what;
}

TEST(Stages, HaveConfigMakeStateAndRestore) {
  const std::string all =
      "struct Config {};\nstatic Governor make(const Config& c);\nint update(int x) noexcept;\n"
      "struct State {};\nState state() const;\nvoid restore(const State& s);";
  const std::string member = "contour::online::Governor governor_;";
  EXPECT_THAT(held(member, all), IsEmpty());
  EXPECT_THAT(held("std::optional<contour::online::Governor> governor_;", "int update(int x);"),
              ElementsAre(HasSubstr("'struct Config'")));
  EXPECT_THAT(held(member, all.substr(0, all.find("void restore"))),
              ElementsAre(HasSubstr("restore(")));
  EXPECT_THAT(held("// contour::online::Governor governor_;", "int update(int x);"), IsEmpty());
  // A class without update() is not a stage: nothing in it changes from cycle to cycle.
  EXPECT_THAT(held(member, "int look(int x) const;"), IsEmpty()) << "nothing changes in it";
}

TEST(Tree, ReportsEveryFilesViolations) {
  const auto violations =
      check_tree({file("steadyrest/kernel/a.hpp", "#include <steadyrest/nc/x.hpp>"),
                  file("steadyrest/sim/b.hpp", "#include <steadyrest/apps/x.hpp>")},
                 rules());
  ASSERT_EQ(violations.size(), 2U);
  EXPECT_EQ(violations[1].path, "steadyrest/sim/b.hpp");
}

TEST(SizeReport, CountsAndNamesLongFiles) {
  std::string text(kSpdx);
  for (int i = 0; i < 450; ++i) {
    text += "int a;\n";
  }
  const std::string report = size_report({{"steadyrest/nc/long.cpp", text}}, rules());
  EXPECT_THAT(report, HasSubstr("steadyrest/nc/long.cpp (451 lines)"));
}

TEST(RulesFile, RefusesWhatIsNotTomlOrIncomplete) {
  EXPECT_FALSE(read_rules("root = ").has_value());
  EXPECT_FALSE(read_rules("root = 'x'").has_value());
}

}  // namespace
}  // namespace house
