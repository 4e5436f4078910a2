// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <steadyrest/motion/offline/log/edge_log.hpp>

namespace steadyrest::motion::offline {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

EdgeLog parsed(const std::string& text, const EdgeLogConfig& config = {}) {
  EdgeLogResult log = parse_edge_log(text, "log.csv", config);
  EXPECT_TRUE(log.has_value()) << kernel::outcome::text(log.error());
  return log ? *log : EdgeLog{};
}

// Binary fractions: 0.5 and 0.625 are exact in any correct reader.
void expect_ten_and_eleven(const EdgeLog& log) {
  ASSERT_EQ(log.rows.size(), 2U);
  EXPECT_EQ(log.rows[0].t_s, 0.5);
  EXPECT_EQ(log.rows[0].count, 10);
  EXPECT_EQ(log.rows[1].t_s, 0.625);
  EXPECT_EQ(log.rows[1].count, 11);
  EXPECT_FALSE(log.stopped);
}

// Each spelling promised in the README, one variation at a time, must give the same two rows.
TEST(EdgeLog, ReadsEverySpellingThatItPromises) {
  for (const std::string text : {
           "t_s,count\n0.5,10\n0.625,11\n",
           "t_s;count\n0.5;10\n0.625;11\n",
           "t_s\tcount\n0.5\t10\n0.625\t11\n",
           "t_s,count\r\n0.5,10\r\n0.625,11\r\n",
           "\xef\xbb\xbft_s,count\n0.5,10\n0.625,11\n",
           "# a comment\n\nt_s,count\n0.5,10\n# another\n  \n0.625,11\n",
           "count,t_s\n10,0.5\n11,0.625\n",
           "axis,t_s,load,count,note\nX,0.5,3,10,\nX,0.625,,11,b\n",
           "\"t_s\", \"count\"\n 0.5 , 10 \n0.625,11\n",
           "t_s,count\n5e-1,1.0e1\n+0.625,+11\n",
           "t_s,count\n0.5,10.000\n6.250000000000000000e-01,1.100000000000000000e+01\n",
           "t_s,count\n0.5,10\n0.625,11",
           "t_s,count\r\n0.5,10\r\n0.625,11\r",
       }) {
    const EdgeLog log = parsed(text);
    EXPECT_EQ(log.finding_count, 0U) << text;
    expect_ten_and_eleven(log);
  }
}

// Every block size from one byte up: a line may be split anywhere, even between CR and LF.
TEST(EdgeLog, ReadsTheSameHoweverItComesInBlocks) {
  const std::string text = "# log\r\nt_s,count\r\n0.5,10\r\n0.625,11\r\n";
  for (std::size_t size = 1; size <= text.size(); ++size) {
    EdgeLogReader reader("log.csv", {});
    for (std::size_t at = 0; at < text.size(); at += size) {
      EXPECT_TRUE(reader.take(std::string_view(text).substr(at, size)));
    }
    const EdgeLogResult log = reader.finish();
    ASSERT_TRUE(log.has_value());
    expect_ten_and_eleven(*log);
  }
}

// 5101 continues 5050; 510 is a truncated number.
TEST(EdgeLog, KeepsALastRowWithoutLineEndThatGoesOnAsBefore) {
  EXPECT_EQ(parsed("t_s,count\n0,5000\n0.001,5050\n0.002,5101").rows.size(), 3U);
  EXPECT_EQ(parsed("t_s,count\n0,5000\n0.001,5050\n0.002,510").rows.size(), 2U);
}

// Two edges within a clock period are real; two ticks at one time are not.
TEST(EdgeLog, LeavesRepeatedStampsOfTicksOut) {
  const std::string text = "t_s,count\n0,5\n0.001,6\n0.001,7\n0.002,8\n";
  EXPECT_EQ(parsed(text).rows.size(), 4U);  // two edges within one period of the clock
  EdgeLogConfig config;
  config.rising_time = true;
  config.max_step = 0;
  const EdgeLog log = parsed(text, config);
  EXPECT_EQ(log.rows.size(), 3U);
  ASSERT_EQ(log.findings.size(), 1U);
  EXPECT_EQ(log.findings[0].line, 4U);
}

TEST(EdgeLog, ReportsWhatIsFasterThanTheAxis) {
  EdgeLogConfig config;
  config.max_step = 0;  // ticks
  config.max_speed_counts_s = 1000.0;
  // One count may always be due; 11 within 10 ms are not.
  const EdgeLog log = parsed("t_s,count\n0,0\n0.01,11\n0.02,23\n0.03,22\n", config);
  EXPECT_EQ(log.rows.size(), 4U);
  EXPECT_EQ(log.jumps, 1U);
  ASSERT_EQ(log.findings.size(), 1U);
  EXPECT_EQ(log.findings[0].line, 4U);
  EXPECT_THAT(log.findings[0].what, HasSubstr("faster than the axis"));
}

// All are counted, twenty are reported, and the fault that ends the log is always included.
TEST(EdgeLog, CountsAllFindingsButKeepsTheFirst) {
  std::string text = "t_s,count\n";
  for (int i = 0; i < 100; ++i) {
    text += fmt::format("{},{}\n", i, 3 * i);
  }
  const EdgeLog log = parsed(text + "x,1\n");
  EXPECT_EQ(log.jumps, 99U);
  EXPECT_EQ(log.finding_count, 100U);
  EXPECT_EQ(log.findings.size(), EdgeLogConfig{}.max_findings + 1);
  EXPECT_TRUE(log.stopped);
  EXPECT_EQ(log.findings.back().line, 102U);
}

// A file without line ends must not be collected in memory.
TEST(EdgeLog, EndsAtALineThatNeverEnds) {
  const std::string endless(100000, '1');
  EXPECT_FALSE(parse_edge_log(endless, "log.csv"));
  const EdgeLog log = parsed("t_s,count\n0.5,10\n0.625,11\n" + endless);
  EXPECT_TRUE(log.stopped);
  expect_ten_and_eleven(parsed("t_s,count\n0.5,10\n0.625,11\n"));
  EXPECT_EQ(log.rows.size(), 2U);
  EXPECT_EQ(log.findings.back().line, 4U);
}

// The coarsest 1, 2 or 5·10ⁿ that fits all stamps, up to the digits that are written.
TEST(EdgeLog, FindsThePeriodOfTheClock) {
  const auto clock = [](const std::string& rows) { return clock_of(parsed("t_s,count\n" + rows)); };
  EXPECT_DOUBLE_EQ(clock("0.000,1\n0.001,2\n0.012,3\n"), 1e-3);
  EXPECT_DOUBLE_EQ(clock("0.0000000,1\n0.0010003,2\n0.0120005,3\n"), 1e-7);
  EXPECT_DOUBLE_EQ(clock("0.000000000,1\n0.001000300,2\n0.012000500,3\n"), 1e-7);
  EXPECT_DOUBLE_EQ(clock("0.000000000,1\n0.001000400,2\n0.012000600,3\n"), 2e-7);
  EXPECT_DOUBLE_EQ(clock("0.00000,1\n0.00015,2\n0.01205,3\n"), 5e-5);
  EXPECT_DOUBLE_EQ(clock("0.30000000000000004,1\n0.70000000000000007,2\n"), 0.1);
  EXPECT_DOUBLE_EQ(clock("1.000000001,1\n1.000000002,2\n"), 1e-9);
  EXPECT_DOUBLE_EQ(clock("1e-7,1\n3e-7,2\n"), 1e-7);
  EXPECT_EQ(clock("1.0000000001,1\n1.000000002,2\n"), 0.0);
}

// At 80 000 s a double's digits end at 10⁻¹¹ s: the rounding must not pass for a finer clock.
TEST(EdgeLog, FindsThePeriodOfTheClockLateInALongLog) {
  std::string text = "t_s,count\n";
  for (int i = 0; i < 1000; ++i) {
    text += fmt::format("{:.7f},{}\n", 80000.0 + 1e-7 * (7919.0 * i), i);
  }
  EXPECT_DOUBLE_EQ(clock_of(parsed(text)), 1e-7);
}

/// What a file's first line promises: `# refuse LINE: piece`, `# stop LINE keeping ROWS: piece`
/// or `# report LINE keeping ROWS: piece`.
struct Promise {
  std::string grade;
  std::size_t line = 0;
  std::size_t rows = 0;
  std::string piece;
};

Promise promise_of(const fs::path& file) {
  // Files with no room for a comment.
  static const std::map<std::string, Promise> kBare{
      {"empty.csv", {"refuse", 0, 0, "is empty"}},
      {"compressed.csv.gz", {"refuse", 0, 0, "is gzip-compressed; unpack it: zcat"}},
      {"utf-16.csv", {"refuse", 0, 0, "is UTF-16 text"}},
      {"carriage-returns-alone.csv", {"refuse", 1, 0, "bare carriage return"}},
      {"noughts.csv", {"refuse", 1, 0, "control characters"}},
  };
  if (const auto bare = kBare.find(file.filename()); bare != kBare.end()) {
    return bare->second;
  }
  std::ifstream in(file);
  std::string head;
  std::getline(in, head);
  if (head.ends_with('\r')) {
    head.pop_back();
  }
  const std::size_t colon = head.find(": ");
  std::istringstream words(head.substr(2, colon - 2));
  Promise out;
  std::string keeping;
  words >> out.grade >> out.line >> keeping >> out.rows;
  out.piece = head.substr(colon + 2);
  return out;
}

// A corpus of files, each naming in its first line the expected report and its place.
TEST(RefusedLogs, AreJudgedAtTheLineAndForTheFaultThatTheirFirstLineNames) {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STEADYREST_SOURCE_DIR) / "tests/refused/motion")) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  ASSERT_GE(files.size(), 50U);
  for (const fs::path& file : files) {
    const Promise promise = promise_of(file);
    const EdgeLogResult log = read_edge_log(file.string());
    ASSERT_EQ(log.has_value(), promise.grade != "refuse")
        << file << (log ? "" : kernel::outcome::text(log.error()));
    const auto& fault = log ? log->findings.front() : log.error();
    EXPECT_EQ(fault.line, promise.line) << file << " " << fault.what;
    EXPECT_EQ(fault.file, file.string());
    EXPECT_THAT(fault.what + "; " + fault.to_do, HasSubstr(promise.piece)) << file;
    if (log) {
      EXPECT_EQ(log->rows.size(), promise.rows) << file;
      EXPECT_EQ(log->stopped, promise.grade == "stop") << file;
    }
  }
}

TEST(RefusedLogs, AFileThatIsNotThereIsRefused) {
  const EdgeLogResult log = read_edge_log("none.csv");
  ASSERT_FALSE(log.has_value());
  EXPECT_THAT(log.error().what, HasSubstr("cannot be opened"));
  EXPECT_FALSE(read_edge_log(fs::temp_directory_path().string()).has_value());
}

TEST(EdgeLog, ReadsAMillionLinesCutMidRow) {
  const fs::path path = fs::temp_directory_path() / fmt::format("steadyrest-log-{}.csv", getpid());
  {
    std::string text = "t_s,count\n";
    for (int i = 0; i < 1000000; ++i) {
      text += fmt::format("{:.9f},{}\n", 1e-4 * i, i);
    }
    text.resize(text.size() - 9);  // "99.9999|00000,999999" loses its count
    std::ofstream(path, std::ios::binary) << text;
  }
  const EdgeLogResult log = read_edge_log(path.string());
  fs::remove(path);
  ASSERT_TRUE(log.has_value());
  EXPECT_EQ(log->rows.size(), 999999U);
  ASSERT_EQ(log->findings.size(), 1U);
  EXPECT_EQ(log->findings[0].line, 1000001U);
}

}  // namespace
}  // namespace steadyrest::motion::offline
