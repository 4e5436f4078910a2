// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <iterator>

#include <steadyrest/trial/replay/testing/recorded_cut.hpp>

namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

/// Records the start of the example circle, the record of examples/: record_example OUT.sqlite
int main(int argc, char** argv) {
  namespace trial = steadyrest::trial;
  constexpr std::uint64_t kCycles = 7200;
  const std::string name = "ideal-k50.toml";
  if (argc != 2) {
    std::fputs("usage: record_example OUT.sqlite\n", stderr);
    return 2;
  }
  const auto cut = trial::replay::testing::record_cut(
      argv[1], trial::test::machine_of(name), kCycles, 0,
      {.start_utc = "2026-11-26T08:00:00Z",
       .machine_text = text_of(trial::test::kExamples + "machines/" + name),
       .program_text = text_of(trial::test::kExamples + "programs/circle-r10.mpf")});
  return cut.cycles == kCycles && cut.dropped == 0 ? 0 : 1;
}
