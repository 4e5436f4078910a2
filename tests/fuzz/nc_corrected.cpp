// SPDX-License-Identifier: Apache-2.0
#include "nc_corrected.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <unistd.h>

#include <steadyrest/nc/interpret/program.hpp>

// A program, a plan for it, and files to work on, for the fuzz targets of the rewriter. The plan
// must fit the program, or nothing would ever be inserted.
namespace steadyrest::fuzz {
namespace {

namespace interpret = nc::interpret;
namespace rewrite = nc::rewrite;
using kernel::machine::Machine;

/// Roughly how long a program takes: exact times do not matter, plans are placed within a window.
class Length final : public interpret::Sink {
 public:
  void on_move(const interpret::Move& move) override {
    ++moves;
    double distance = 0.0;
    for (std::size_t i = 0; i < move.end.size(); ++i) {
      distance += std::abs(move.end[i] - move.start[i]);
    }
    const double feed = move.kind == interpret::MoveKind::rapid ? 100.0 : move.feed_mm_s;
    const double turns = 1.0 + std::abs(move.turns);
    seconds += move.dwell_s + (distance + 100.0 * (turns - 1.0)) / std::max(feed, 1e-9);
  }
  void on_event(const interpret::Event& /*event*/) override { seconds += 5.0; }
  double seconds = 0.0;
  std::size_t moves = 0;
};

/// Corrections between 30 % and 80 % of the time, where a program has moves before and after.
rewrite::AxisPlan axis_plan(char letter, std::size_t index, double total_s, bool many) {
  constexpr std::array kOnce = {10.0, -5.5};
  constexpr std::array kOften = {10.0, -5.5, 3.0, 20.123, 7.0, -2.0};
  rewrite::AxisPlan plan;
  plan.letter = letter;
  plan.index = index;
  const std::size_t steps = many ? kOften.size() : kOnce.size();
  for (std::size_t i = 0; i < steps; ++i) {
    plan.steps.push_back(
        {.time_s = total_s * (0.3 + 0.5 * static_cast<double>(i) / static_cast<double>(steps)),
         .displacement_um = many ? kOften[i] : kOnce[i]});
  }
  return plan;
}

}  // namespace

Job::Job(std::string_view program, rewrite::Method method, std::uint8_t choice) : text(program) {
  settings.method = method;
  settings.r_parameter = 50;
  settings.window_s = (choice & 4U) != 0 ? 2.0 : 60.0;
  const auto chosen =
      static_cast<std::size_t>(std::ranges::find(kMethods, method) - kMethods.begin());
  config.dialect = static_cast<nc::read::Dialect>(kDialectOf[chosen]);
  config.external_offset = method != rewrite::Method::haas;
  config.most_repeated_lines = 2000;
}

/// Long programs cost time and find no more than short ones.
bool Job::plan_it(std::uint8_t choice) {
  constexpr std::size_t kMostMoves = 500;
  constexpr double kMost_s = 60.0;  // a plan may differ from the program by 30 s
  Length length;
  const auto report = interpret::run_text(text, config, length);
  if (!report || !report->refused.empty() || length.moves == 0 || length.moves > kMostMoves ||
      !(length.seconds < kMost_s)) {
    return false;
  }
  plan.total_s = length.seconds;
  plan.axes.push_back(axis_plan('Z', 2, plan.total_s, (choice & 1U) != 0));
  if ((choice & 2U) != 0 && !rewrite::beside_program(settings.method)) {
    plan.axes.push_back(axis_plan('X', 0, plan.total_s, (choice & 8U) != 0));
  }
  return true;
}

/// A coarse cycle makes timing quick; rotary axes allow rotary words.
const Machine& mill() {
  static const Machine made = [] {
    Machine machine;
    for (const char* name : {"X", "Y", "Z", "A", "B", "C"}) {
      kernel::machine::Axis axis;
      axis.name = name;
      axis.rotary = *name < 'X';
      machine.axes.push_back(axis);
    }
    machine.control.interpolator_period_s = 0.2;
    return machine;
  }();
  return made;
}

/// In memory where possible: the targets write thousands of files per second.
Files::Files() {
  namespace fs = std::filesystem;
  std::error_code absent;
  const fs::path memory = "/dev/shm";
  const fs::path root = fs::is_directory(memory, absent) && ::access(memory.c_str(), W_OK) == 0
                            ? memory
                            : fs::temp_directory_path();
  folder = (root / ("steadyrest-fuzz-" + std::to_string(::getpid()))).string();
  fs::create_directories(folder);
  original = folder + "/original";
  changed = folder + "/changed";
}

Files::~Files() {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

Files& files() {
  static Files made;
  return made;
}

void write_file(const std::string& path, std::string_view text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace steadyrest::fuzz
