// SPDX-License-Identifier: Apache-2.0
// The disk is full while a run is recorded: the record ends, the run goes on and says so.
#include <array>
#include <cstdio>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/cli/shared/program.hpp>
#include <tests/cli/shared/scratch.hpp>

namespace steadyrest::test {
namespace {

/// Whether this status says that the record has ended.
bool is_ended(const std::string& status) {
  const auto json = nlohmann::json::parse(status, nullptr, false);
  return json.is_object() && json.contains("record_fault") && json["record_fault"].is_string();
}

/// What a shell's line prints.
std::string printed(const std::string& line) {
  std::string out;
  FILE* const pipe = ::popen(line.c_str(), "r");
  std::array<char, 4096> part{};
  for (std::size_t got = 1; got > 0;) {
    got = std::fread(part.data(), 1, part.size(), pipe);
    out.append(part.data(), got);
  }
  EXPECT_EQ(::pclose(pipe), 0) << line;
  return out;
}

TEST(DiskFull, EndsTheRecordAndNotTheRun) {
  const Scratch scratch;
  // What the running layer says, asked from the side.
  std::string status;
  const std::jthread asker([&](const std::stop_token& stop) {
    const std::string ask = std::string("'") + STEADYREST_PROGRAM + "' status --json --socket '" +
                            scratch.at("s") + "' 2>/dev/null || true";
    while (!stop.stop_requested() && !is_ended(status)) {
      status = printed(ask);
    }
  });
  // No file may be larger than 160 blocks of 512 bytes: enough to begin.
  const std::string text =
      printed("ulimit -f 160; cd '" + scratch.at("") + "' && { " + STEADYREST_PROGRAM +
              " run --json --for-s 3 --mode act --socket s --record runs --machine " +
              project_file("examples/machines/vmc-840d.toml") + " --program " +
              project_file("examples/programs/circle-r10.mpf") +
              " 2>said; test $? -eq 1; }");  // what was asked for is not done
  const auto answer = nlohmann::json::parse(text, nullptr, false);
  ASSERT_TRUE(answer.is_object()) << text;
  EXPECT_GE(answer["cycles"], 750) << "3 s of 4 ms";
  ASSERT_TRUE(answer["record"]["fault"].is_string()) << answer["record"].dump();
  EXPECT_GT(answer["record"]["dropped"], 0);
  EXPECT_EQ(answer["port_faults"], 0);
  EXPECT_TRUE(is_ended(status)) << status;
  const std::string said = text_of_file(scratch.at("said"));
  const auto at = said.find("steadyrest: warning: the record ended, the run goes on: ");
  ASSERT_NE(at, std::string::npos) << said;
  EXPECT_EQ(said.find("the record ended, the run", at + 30), std::string::npos) << "once";
}

}  // namespace
}  // namespace steadyrest::test
