// SPDX-License-Identifier: Apache-2.0
// Compensating (read, write, prove): lines per second of CPU time on one core, compared with
// LinuxCNC's `rs274 -g` on the same file in the same run. CPU time, so that other load matters
// little.
//
//   steadyrest_nc_compensate_bench [REPEATS]
//
// The programs are two of the shared data, REPEATS times one after the other; what no control reads
// (E words, M82, M84) is removed from the second. The first line sets the modes that these programs
// leave to the control, without which no correction would be certain.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <regex>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/file/testing/recorded.hpp>
#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/program.hpp>
#include <steadyrest/nc/plan/time/segment_timer.hpp>
#include <steadyrest/nc/rewrite/correct/compensate.hpp>

namespace {

using namespace steadyrest;

/// User and system time of this process (or of its children, for rs274).
double cpu_s(int whose) {
  rusage used{};
  getrusage(whose, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

double spent_s(int whose, const std::function<void()>& work) {
  const double before = cpu_s(whose);
  work();
  return cpu_s(whose) - before;
}

/// As examples/machines/linuxcnc-mill.toml, so that both sides plan for the same control.
kernel::machine::Machine mill() {
  kernel::machine::Machine m;
  for (const char* name : {"X", "Y", "Z"}) {
    kernel::machine::Axis axis;
    axis.name = name;
    m.axes.push_back(axis);
  }
  m.control.max_path_acceleration_mm_s2 = 3000.0;
  m.control.max_feed_mm_s = 250.0;
  m.control.corner_tolerance_mm = 10.0;
  m.control.junction_deviation_mm = 0.0;
  m.control.junction_share = 0.1;
  m.control.blend_gap_cycles = 4.0;
  m.control.min_block_cycles = 1.02;
  m.control.merge_share = 1.0;
  m.control.corner_acceleration_share = 0.5;
  m.control.stop_between_rapid_and_feed = true;
  return m;
}

/// Writes the program at `path`, returns its lines: a print job without its extruder words is a
/// plain three-axis program of many short moves.
std::size_t make_program(const std::string& from, const std::string& path, int repeats) {
  const std::regex unread("^(G92 E|M82|M84|M2).*");
  const std::regex extruder(" *E-?[0-9.]+");
  std::string body;
  std::size_t lines = 0;
  std::ifstream in(from);
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, unread)) {
      body += std::regex_replace(line, extruder, "") + "\n";
      ++lines;
    }
  }
  std::ofstream out(path);
  out << "G17 G21 G40 G49 G54 G80 G90 G94\n";
  for (int i = 0; i < repeats; ++i) {
    out << body;
  }
  out << "M2\n";
  return lines == 0 ? 0 : lines * static_cast<std::size_t>(repeats) + 2;
}

/// Corrections of Z at a quarter, a half and three quarters of the time. The program's time must be
/// known for that, so it is measured first, which gives the cost of reading and timing as well.
nc::rewrite::Plan quarters(double total_s) {
  const std::string quarter = std::to_string(total_s / 240.0);
  const std::string text = R"({"transitions": [{"n": 4, "t_min": [)" + quarter + "," + quarter +
                           "," + quarter + "," + quarter + R"(], "delta_um": [0, 50, 50, -30]}]})";
  return nc::rewrite::parse_plan(text, "plan.json").value();
}

void measure(const std::string& name, const std::string& from, const std::string& folder,
             int repeats) {
  const std::string program = folder + "/program.ngc";
  const auto lines = static_cast<double>(make_program(from, program, repeats));
  if (lines == 0.0) {
    std::printf("%s: the shared data is absent\n", name.c_str());
    return;
  }
  const auto machine = mill();
  nc::interpret::Config config;
  config.axes = "XYZ";
  auto timer = nc::plan::SegmentTimer::make(machine).value();
  double total_s = 0.0;
  const double timing_s = spent_s(RUSAGE_SELF, [&] {
    if (!nc::interpret::run_file(program, config, timer)) {
      std::abort();
    }
    total_s = timer.take().value();
  });
  const auto plan = quarters(total_s);
  const double ours_s = spent_s(RUSAGE_SELF, [&] {
    const auto made =
        nc::rewrite::compensate(program, folder + "/changed.ngc", plan, config, machine, {});
    if (!made) {
      std::printf("%s\n", made.error().what.c_str());
      std::exit(1);
    }
  });
  // rs274 only interprets; it neither plans nor proves. The ratio reflects a user's waiting time.
  const double theirs_s = spent_s(RUSAGE_CHILDREN, [&] {
    if (std::system(("rs274 -g " + program + " > /dev/null 2>&1").c_str()) != 0) {
      std::printf("rs274 is not installed, or refuses the program\n");
    }
  });
  std::printf(
      "%-18s %9.0f lines  compensate %7.0f ns (%.2f M lines/s)  read and time %6.0f ns  "
      "rs274 %7.0f ns (%.2f M lines/s)  ratio %.1f\n",
      name.c_str(), lines, 1e9 * ours_s / lines, 1e-6 * lines / ours_s, 1e9 * timing_s / lines,
      1e9 * theirs_s / lines, 1e-6 * lines / theirs_s, theirs_s / ours_s);
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 10;
  const std::string data = steadyrest::kernel::file::testing::shared_data();
  // Two runs at once must not share the changed file.
  const steadyrest::kernel::file::testing::OwnFolder own;
  const std::string folder = own.path();
  measure("linuxcnc_sample", data + "/nc/gpr/linuxcnc_sample.ngc", folder, repeats);
  measure("part", data + "/nc/cncjs/part.gcode", folder, repeats);
  return 0;
}
