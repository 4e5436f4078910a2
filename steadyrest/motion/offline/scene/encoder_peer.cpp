// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/motion/offline/scene/encoder_peer.hpp>

// LinuxCNC's encoder component runs in a separate program, since the package is GPL and may be
// missing; edges go over as CSV, estimates come back as CSV.
namespace steadyrest::motion::offline {
namespace {

namespace fs = std::filesystem;
using kernel::file::OutputFile;
using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr int kNotInstalled = 77;

Refusal unavailable(const fs::path& program, std::string what, std::string to_do) {
  return {Kind::unavailable, program.string(), 0, std::move(what), std::move(to_do)};
}

/// A temporary file: an output that is never committed.
Result<OutputFile> scratch() {
  return OutputFile::open((fs::temp_directory_path() / "steadyrest-peer.csv").string());
}

void write_edges(const Record& record, OutputFile& file) {
  std::string out =
      fmt::format("t_s,count\n{},{}\n", record.ticks.front().t_s, record.ticks.front().count);
  const auto at = std::back_inserter(out);
  for (const online::Edge& edge : record.edges) {
    fmt::format_to(at, "{},{}\n", edge.t_s, edge.direction > 0 ? edge.line : edge.line - 1);
  }
  // The shortest text that reads back as the same double: nothing is lost on the way.
  fmt::format_to(at, "{},{}\n", record.ticks.back().t_s, record.ticks.back().count);
  file.write(out);
}

/// Exit code of the program, −1 when it could not be run; its output is ignored.
int run_program(std::vector<std::string> words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (failed != 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    return -1;
  }
  return WEXITSTATUS(status);
}

// The component gives no acceleration: NaN, so that no figure is computed from it.
std::vector<online::Estimate> read_estimates(const Record& record, const fs::path& path) {
  std::vector<online::Estimate> out(record.ticks.size());
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].t_s = record.ticks[k].t_s;
    out[k].acceleration_mm_s2 = std::numeric_limits<double>::quiet_NaN();
  }
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  for (std::size_t k = 1; k < out.size() && std::getline(in, line); ++k) {
    double t_s = 0.0;
    double velocity_counts_s = 0.0;
    double position_counts = 0.0;
    // NOLINTNEXTLINE(cert-err34-c): our own test program wrote it
    if (std::sscanf(line.c_str(), "%lf,%*d,%lf,%lf", &t_s, &velocity_counts_s, &position_counts) ==
        3) {
      out[k].velocity_mm_s = velocity_counts_s * record.how.count_mm;
      out[k].position_mm = position_counts * record.how.count_mm;
    }
  }
  return out;
}

}  // namespace

Result<std::vector<online::Estimate>> run_encoder_peer(const fs::path& program,
                                                       const Record& record) {
  auto edges = scratch();
  const auto out = scratch();
  if (!edges || !out) {
    return std::unexpected(edges ? out.error() : edges.error());
  }
  write_edges(record, *edges);
  if (auto written = edges->flush(); !written) {
    return std::unexpected(std::move(written.error()));
  }
  // The component stamps edges with its base thread's period; the record's clock is the fair
  // equivalent.
  const auto base_ns = std::max(1LL, std::llround(record.how.clock_s * 1e9));
  const int code =
      run_program({program.string(), edges->path(), "--base-ns", std::to_string(base_ns),
                   "--tick-s", fmt::format("{}", 1.0 / record.how.cycle_hz), "-o", out->path()});
  if (code == kNotInstalled) {
    return std::unexpected(unavailable(program, "LinuxCNC's encoder component is not installed",
                                       "install the package linuxcnc-uspace"));
  }
  if (code != 0) {
    return std::unexpected(unavailable(program, fmt::format("does not run (exit code {})", code),
                                       "build steadyrest_encoder_peer and give its path"));
  }
  return read_estimates(record, out->path());
}

}  // namespace steadyrest::motion::offline
