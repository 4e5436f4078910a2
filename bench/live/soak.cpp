// SPDX-License-Identifier: Apache-2.0
// Memory over time of the running loop with every room and the record on, at 1 kHz in real time.
// Fails when the second half needs more than 1 MiB more than the first.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <tests/rig/everything_on.hpp>
#include <unistd.h>

#include <steadyrest/live/loop.hpp>
#include <steadyrest/live/realtime.hpp>
#include <steadyrest/record/recording_port.hpp>

namespace {

using namespace steadyrest;

constexpr double kPeriod_s = 0.001;

long resident_kib() {
  std::ifstream file("/proc/self/statm");
  long size = 0;
  long resident = 0;
  file >> size >> resident;
  return resident * ::sysconf(_SC_PAGESIZE) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Memory of the running loop over time"};
  double minutes = 20.0;
  std::string folder = "/tmp/steadyrest-soak";
  app.add_option("minutes", minutes)->check(CLI::Range(0.1, 1e5))->capture_default_str();
  app.add_option("--record", folder, "folder; a record of before is removed")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv)
  const auto machine = rig::everything_on("linuxcnc-mill");
  const auto cycles = static_cast<std::uint64_t>(minutes * 60.0 / kPeriod_s);
  const auto port =
      rig::chattering(machine, rig::busy_path(machine, static_cast<int>(30.0 * minutes) + 30));
  auto layer = rig::listening(machine, port->capability());
  std::filesystem::create_directories(folder);
  const std::string file = folder + "/soak.sqlite";
  std::filesystem::remove(file);
  const auto writer =
      record::RecordWriter::make(
          {.file = file, .info = {.cycle_s = kPeriod_s, .capability = port->capability()}})
          .value();
  record::RecordingPort recording(*port, *writer);
  live::MonotonicPace pace(kPeriod_s);
  live::Loop loop(recording, layer, pace,
                  {.period_s = kPeriod_s,
                   .contour_limit_mm = machine.contour.limit_mm,
                   .mode = kernel::machine::Mode::act,
                   .most_cycles = cycles,
                   .on_command = [&](const kernel::signal::Command& c) { recording.record(c); }});
  std::atomic<bool> done{false};
  long first_half_kib = 0;
  long second_half_kib = 0;
  std::thread watch([&] {
    const auto begin = std::chrono::steady_clock::now();
    for (int step = 0; !done.load(); ++step) {
      const double passed_s =
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      const long kib = resident_kib();
      long& half = passed_s < 30.0 * minutes ? first_half_kib : second_half_kib;
      half = std::max(half, kib);
      if (step % 10 == 0) {
        fmt::print("{:6.0f} s  {} KiB\n", passed_s, kib);
        std::fflush(stdout);
      }
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  });
  const auto real_time = live::ask_for_real_time();  // the other threads go without
  const live::LoopFigures& figures = loop.run();
  done.store(true);
  watch.join();
  writer->flush();
  fmt::print("real-time priority: {}\n", real_time.priority);
  fmt::print("{} cycles, {} overruns, {} lost to the record of {} MiB\n", figures.cycles,
             figures.overruns, writer->dropped(), std::filesystem::file_size(file) >> 20U);
  fmt::print("at most {} KiB in the first half, {} KiB in the second\n", first_half_kib,
             second_half_kib);
  std::filesystem::remove(file);
  return second_half_kib <= first_half_kib + 1024 ? 0 : 1;
}
