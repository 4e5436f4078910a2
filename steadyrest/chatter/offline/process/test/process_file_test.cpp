// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/chatter/offline/test/cuts.hpp>

namespace steadyrest::chatter::offline::test {
namespace {

namespace fs = std::filesystem;
namespace outcome = kernel::outcome;
using testing::HasSubstr;

const fs::path kCorpus = fs::path(STEADYREST_SOURCE_DIR) / "tests" / "refused" / "process";
const fs::path kExamples = fs::path(STEADYREST_SOURCE_DIR) / "examples" / "processes";

std::vector<std::string> corpus() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCorpus)) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class RefusedProcessFile : public testing::TestWithParam<std::string> {};

/// The first line of a file is `# refuse LINE: a piece of the message`.
TEST_P(RefusedProcessFile, NamesItsFault) {
  const fs::path path = kCorpus / (GetParam() + ".toml");
  std::ifstream in(path);
  std::string first;
  std::getline(in, first);
  constexpr std::string_view kHead = "# refuse ";
  const std::size_t colon = first.find(": ");
  ASSERT_TRUE(first.starts_with(kHead) && colon != std::string::npos) << path;
  const ProcessOrFaults result = read_process_all_faults(path.string());
  ASSERT_FALSE(result) << "was accepted";
  const outcome::Refusal& fault = result.error().front();
  EXPECT_EQ(fault.kind, outcome::Kind::bad_input);
  EXPECT_EQ(fault.file, path.string());
  EXPECT_EQ(fault.line, std::stoul(first.substr(kHead.size()))) << outcome::text(fault);
  if (GetParam() != "syntax") {
    EXPECT_THAT(outcome::text(fault), HasSubstr(first.substr(colon + 2)));
  }
  EXPECT_FALSE(fault.to_do.empty());
  EXPECT_EQ(result.error().size(), 1U) << outcome::text(result.error().back());
}

INSTANTIATE_TEST_SUITE_P(Corpus, RefusedProcessFile, testing::ValuesIn(corpus()),
                         [](const testing::TestParamInfo<std::string>& at) {
                           std::string name = at.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(ProcessFile, CorpusIsThere) {
  EXPECT_GE(corpus().size(), 40U);
}

TEST(ProcessFile, ShowsAllFaultsInTheOrderOfTheirLines) {
  const auto result = parse_process_all_faults(
      "[tool]\nteeth = 0\n[cut]\ntangential_N_mm2 = 1.0\nradial_immersion = 2.0\n", "given.toml");
  ASSERT_FALSE(result);
  const auto& list = result.error();
  ASSERT_EQ(list.size(), 4U);  // no mode, teeth, no radial_N_mm2, immersion
  EXPECT_TRUE(std::ranges::is_sorted(list, {}, &outcome::Refusal::line));
}

TEST(ProcessFile, RefusesNoFileAndAFolder) {
  EXPECT_THAT(outcome::text(read_process("no/such.toml").error()),
              HasSubstr("no/such.toml: cannot be opened: No such file or directory; give the path "
                        "of a process file"));
  EXPECT_THAT(outcome::text(read_process(kCorpus.string()).error()), HasSubstr("is a folder"));
  EXPECT_THAT(outcome::text(parse_process("", "given.toml").error()),
              HasSubstr("given.toml: the file is empty"));
}

TEST(ProcessFile, ReadsTheSlotBenchmark) {
  const auto read = read_process((kExamples / "slot-922hz.toml").string());
  ASSERT_TRUE(read) << outcome::text(read.error());
  const Process wanted = benchmark_cut(1.0, Direction::up);
  EXPECT_EQ(read->tool.teeth, wanted.tool.teeth);
  EXPECT_EQ(read->cut.operation, Operation::milling);
  EXPECT_EQ(read->cut.direction, Direction::up);
  EXPECT_EQ(read->cut.radial_immersion, 1.0);
  EXPECT_EQ(read->cut.tangential_n_mm2, 600.0);
  EXPECT_EQ(read->cut.radial_n_mm2, 200.0);
  ASSERT_EQ(read->modes.size(), 1U);
  EXPECT_EQ(read->modes[0].frequency_hz, 922.0);
  EXPECT_EQ(read->modes[0].damping_ratio, 0.011);
  EXPECT_EQ(read->modes[0].mass_kg, 0.03993);
  EXPECT_EQ(read->modes[0].shape, (std::array{1.0, 0.0}));
}

TEST(ProcessFile, ReadsEveryExample) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(kExamples)) {
    if (entry.path().extension() == ".toml") {
      const auto read = read_process(entry.path().string());
      EXPECT_TRUE(read) << outcome::text(read.error());
      ++count;
    }
  }
  EXPECT_GE(count, 4U);
}

TEST(ProcessFile, TurnsUnitsIntoTheInnerOnes) {
  const auto read = parse_process(
      "[tool]\nteeth = 3\ndiameter_mm = 20\nhelix_deg = 30\npitch_deg = [100, 120, 140]\n"
      "runout_um = [5, -2, -3]\n"
      "[cut]\ndirection = \"down\"\nradial_immersion = 0.25\ntangential_N_mm2 = 700\n"
      "radial_N_mm2 = 210\ntangential_edge_N_mm = 12\nradial_edge_N_mm = 14\n"
      "process_damping_N_mm = 20\nfeed_per_tooth_mm = 0.08\n"
      "[[mode]]\nangle_deg = 30\nfrequency_hz = 100\ndamping_ratio = 0.02\nstiffness_N_um = 4\n",
      "given.toml");
  ASSERT_TRUE(read) << outcome::text(read.error());
  EXPECT_NEAR(read->tool.helix_rad, std::numbers::pi / 6.0, 1e-15);
  EXPECT_NEAR(read->tool.pitch_rad.at(1), 2.0 * std::numbers::pi / 3.0, 1e-14);
  EXPECT_NEAR(read->tool.runout_mm.at(0), 0.005, 1e-15);
  EXPECT_EQ(read->cut.direction, Direction::down);
  EXPECT_EQ(read->cut.edge_tangential_n_mm, 12.0);
  EXPECT_EQ(read->cut.edge_radial_n_mm, 14.0);
  EXPECT_EQ(read->cut.process_damping_n_mm, 20.0);
  EXPECT_EQ(read->cut.feed_per_tooth_mm, 0.08);
  const Mode& mode = read->modes.at(0);
  EXPECT_NEAR(mode.shape[0], std::sqrt(0.75), 1e-15);
  EXPECT_NEAR(mode.shape[1], 0.5, 1e-15);
  EXPECT_NEAR(mode.mass_kg * std::pow(2.0 * std::numbers::pi * 100.0, 2.0), 4e6, 1e-6);
}

TEST(ProcessFile, TakesPitchesAsPeopleRoundThem) {
  const auto read = parse_process(
      "[tool]\nteeth = 3\npitch_deg = [119.99, 120.005, 120.003]\n"
      "[cut]\nradial_immersion = 1\ntangential_N_mm2 = 700\nradial_N_mm2 = 210\n"
      "[[mode]]\naxis = \"y\"\nfrequency_hz = 100\ndamping_ratio = 0.02\nmass_kg = 4\n",
      "given.toml");
  ASSERT_TRUE(read) << outcome::text(read.error());
  const auto& pitch = read->tool.pitch_rad;
  EXPECT_NEAR(pitch[0] + pitch[1] + pitch[2], 2.0 * std::numbers::pi, 1e-14);
  EXPECT_EQ(read->modes[0].shape, (std::array{0.0, 1.0}));
}

}  // namespace
}  // namespace steadyrest::chatter::offline::test
