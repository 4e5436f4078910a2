// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <sys/resource.h>
#include <unistd.h>

#include <steadyrest/kernel/testing/cases.hpp>
#include <steadyrest/nc/interpret/state/refusals.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

namespace steadyrest::nc::interpret {
namespace {

namespace fs = std::filesystem;

struct Count final : public Sink {
  std::uint64_t moves = 0;
  void on_move(const Move& /*move*/) override { ++moves; }
  void on_event(const Event& /*event*/) override {}
};

std::vector<fs::path> corpus() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(STEADYREST_SOURCE_DIR) / "tests/refused/nc")) {
    if (entry.path().extension() == ".ngc") {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  return files;
}

/// `fault -> line: piece of the message`, [ ] for ( ), out of the first line's comment.
struct Expected {
  std::size_t line = 0;
  std::string piece;
};
Expected expected_of(const fs::path& file) {
  std::ifstream in(file);
  std::string head;
  std::getline(in, head);
  const auto arrow = head.rfind(" -> ");
  const auto colon = head.find(": ", arrow);
  Expected expected;
  expected.line = std::stoul(head.substr(arrow + 4, colon - arrow - 4));
  expected.piece = head.substr(colon + 2);
  if (head.front() == '(') {
    expected.piece.pop_back();
  }
  std::ranges::replace(expected.piece, '[', '(');
  std::ranges::replace(expected.piece, ']', ')');
  return expected;
}

TEST(RefusedPrograms, AreRefusedAtTheLineAndForTheFaultThatTheirFirstLineNames) {
  // The files are the truth: each names its fault, its line and a part of the required text.
  const auto files = corpus();
  ASSERT_GE(files.size(), 100U);
  for (const fs::path& file : files) {
    Config config;
    config.dialect = read::dialect_from_name(file.parent_path().filename().string()).value();
    config.most_repeated_lines = 100'000;
    Count sink;
    const auto report = run_file(file.string(), config, sink);
    ASSERT_TRUE(report.has_value()) << file;
    ASSERT_FALSE(report->refused.empty()) << file;
    const Expected expected = expected_of(file);
    EXPECT_EQ(report->refused.front().line, expected.line) << file;
    EXPECT_NE(report->refused.front().text.find(expected.piece), std::string::npos)
        << file << ": " << report->refused.front().text;
  }
}

// Of several G words, the faulty one as written.
TEST(RefusedPrograms, ShowTheWordAtFault) {
  const std::pair<const char*, const char*> cases[] = {{"G17 F9 G2 X1\n", "G2"},
                                                       {"G90.1 F9 G2 X1 I1\n", "G2"},
                                                       {"G17 G1 X5\n", "G1"},
                                                       {"G17 G1 X5 F0\n", "F0"},
                                                       {"G41.1 D1\nG90 G59\n", "G59"},
                                                       {"G41.1 D1\nG90 G59.1\n", "G59.1"},
                                                       {"G41.1 D1\nG90 G59.10\n", "G59.10"},
                                                       {"G41.1 D1\nG90.1 G61.1\n", "G61.1"},
                                                       {"G91.1 G53 G90 G0 X1\nG91 G53 X1\n", "G53"},
                                                       {"M3 M72\n", "M72"}};
  for (const auto& [text, word] : cases) {
    Kept kept;
    const auto report = run_text(text, Config{}, kept);
    ASSERT_TRUE(report && !report->refused.empty()) << text;
    EXPECT_EQ(report->refused.front().word, word) << text;
  }
}

// A code is found by its tenth, whatever else of its whole number the block has.
TEST(RefusedPrograms, TellAWordFromItsTenths) {
  read::Block block;
  block.reset(7);
  for (const char* text : {"G59.1", "G59", "G59.3"}) {
    block.push({.letter = 'G', .value = std::stod(text + 1), .name = {}, .text = text});
  }
  Step step{};
  step.reset(block);
  Refusals refusals;
  const std::pair<int, const char*> cases[] = {{g::kWorkOffset6, "G59"},
                                               {g::kWorkOffset7, "G59.1"},
                                               {g::kWorkOffset9, "G59.3"},
                                               {g::kWorkOffset8, "G59.1"}};  // absent: the first
  for (const auto& [code, word] : cases) {
    EXPECT_FALSE(refusals.g_word(step, code, "reason", "text"));
    EXPECT_EQ(refusals.last().word, word);
    EXPECT_EQ(refusals.last().line, 7U);
  }
}

TEST(RefusedPrograms, AProgramCutOffAnywhereIsNeverAccepted) {
  // None of these is a whole program, even where the last word is cut to another legal one (X10.5
  // to X1).
  const std::string whole = "G21 G90\nF100 G1 X10.5\nG2 X20 I4.75\n";
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    EXPECT_NE(reason_of(whole.substr(0, length)), "") << length;
  }
}

// LinuxCNC's memory may hold an offset that G92.2 has put aside by hand.
TEST(RefusedPrograms, OnTheControlAnOffsetPutAsideBeforeIsNotKnown) {
  Config config;
  config.on_control = true;
  Count sink;
  const auto before = run_text("G21 G92.3\nM2\n", config, sink);
  ASSERT_EQ(before->refused.size(), 1U);
  EXPECT_EQ(before->refused.front().reason, "parameter_of_the_control");
  EXPECT_TRUE(run_text("G21 G92 X3\nG92.2\nG92.3\nM2\n", config, sink)->refused.empty());
}

TEST(RefusedPrograms, AMissingEndIsAtTheFilesLastLineHoweverOftenLoopsRan) {
  const Config config;
  Count sink;
  const auto report =
      run_text("G21 G90\no1 repeat [5]\nG1 X1 F100\nX0\no1 endrepeat\nG0 X5\n", config, sink);
  ASSERT_TRUE(report.has_value());
  ASSERT_EQ(report->refused.size(), 1U);
  EXPECT_EQ(report->refused.front().reason, "no_program_end");
  EXPECT_EQ(report->refused.front().line, 6U);
}

TEST(RefusedPrograms, RandomBytesNeverHangCrashOrMoveFar) {
  // No oracle but bounds: it ends, does not crash, and says something.
  std::mt19937 random(20240607);
  for (int i = 0; i < (kernel::testing::kSanitized ? 100 : 500); ++i) {
    std::string text(static_cast<std::size_t>(random() % 2000), ' ');
    for (char& c : text) {
      c = static_cast<char>(random() & 0xffU);
    }
    for (const auto dialect :
         {read::Dialect::linuxcnc, read::Dialect::fanuc, read::Dialect::sinumerik}) {
      Config config;
      config.dialect = dialect;
      Count sink;
      const auto report = run_text(text, config, sink);
      ASSERT_TRUE(report.has_value());
      EXPECT_LE(report->refused.size(), Report::kMostRefused);
    }
  }
}

TEST(RefusedPrograms, AFileWithoutLineEndsIsRefusedWithoutReadingItWhole) {
  const fs::path file = fs::temp_directory_path() / ("nc-sparse-" + std::to_string(::getpid()));
  std::ofstream(file).close();
  // 200 MB of zero bytes, no line end: the refusal must come after 64 KiB.
  fs::resize_file(file, 200'000'000);
  Count sink;
  const auto report = run_file(file.string(), {}, sink);
  fs::remove(file);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->refused.front().reason, "line_too_long");
}

TEST(RefusedPrograms, AMissingFileAndADirectoryAreRefused) {
  Count sink;
  EXPECT_FALSE(run_file("/nonexistent.ngc", {}, sink).has_value());
  EXPECT_FALSE(run_file("/", {}, sink).has_value());
}

long peak_kib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(Program, OfTwoHundredMegabytesIsStreamedInBoundedMemory) {
  // A pipe has no length and no way back, so nothing can be read twice or mapped.
  int ends[2] = {-1, -1};
  ASSERT_EQ(::pipe(ends), 0);
  constexpr std::uint64_t kLines =
      kernel::testing::kSanitized ? 200'000 : 8'000'000;  // 25 bytes each
  const std::string two = "G1 X10.5000 Y20.25 F1000\nG1 X11.5000 Y21.25 F1000\n";
  std::string chunk;
  for (int i = 0; i < 1000; ++i) {
    chunk += two;
  }
  std::thread writer([&] {
    for (std::uint64_t written = 0; written < kLines; written += 2000) {
      if (::write(ends[1], chunk.data(), chunk.size()) < 0) {
        break;
      }
    }
    ::close(ends[1]);
  });
  const long before = peak_kib();  // a sanitizer needs its own memory
  Count sink;
  const auto report = run_file("/proc/self/fd/" + std::to_string(ends[0]), {}, sink);
  ::close(ends[0]);
  writer.join();
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(sink.moves, kLines);
  EXPECT_EQ(report->refused.front().reason, "no_program_end");
  if (!kernel::testing::kSanitized) {
    EXPECT_LT(peak_kib() - before, 8 * 1024);
  }
}

}  // namespace
}  // namespace steadyrest::nc::interpret
