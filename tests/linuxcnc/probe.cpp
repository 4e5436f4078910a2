// SPDX-License-Identifier: Apache-2.0
// A layer of the simplest kind on a running LinuxCNC: it reads frames and, if told, holds a feed
// ratio.
//
//   steadyrest_linuxcnc_probe --frames 3000 -o OUT.csv --ratio 0.5 --from 1000
//
// OUT.csv, a row per frame:
// time_s,age_s,motion,line,speed_mm_s,feed_mm_s,effective,command_x,command_y,
// actual_x,actual_y,error_x,error_y,spindle_rev_s (program, drive, measured). Exit: 0 done, 1 the
// link was lost, 2 refused.
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <steadyrest/adapters/linuxcnc/hal_process.hpp>
#include <steadyrest/adapters/linuxcnc/linuxcnc_port.hpp>

namespace {

using steadyrest::adapters::linuxcnc::HalProcess;
using steadyrest::adapters::linuxcnc::LinuxCncPort;
namespace outcome = steadyrest::kernel::outcome;
namespace signal = steadyrest::kernel::signal;

struct Options {
  std::size_t frames = 1000;
  std::size_t from = 0;
  double ratio = -1.0;
  double spindle_ratio = 1.0;
  double offset_z_mm = 0.0;
  double path_offset_z_mm = 0.0;
  double servo_period_s = 0.001;
  std::string name = "steadyrest";
  std::string out;
};

int refused(const outcome::Refusal& refusal) {
  fmt::print(stderr, "{}\n", outcome::text(refusal));
  return refusal.kind == outcome::Kind::bad_input ? 2 : 1;
}

/// Reads the frames and beats; the first refusal ends it.
outcome::Result<std::vector<signal::Frame>> cycle(LinuxCncPort& port, const Options& options) {
  std::vector<signal::Frame> frames;
  frames.reserve(options.frames);
  signal::Command command;
  command.write = true;
  command.spindle_ratio = options.spindle_ratio;
  command.spindle_masks_panel = true;
  command.offset_mm[2] = options.offset_z_mm;
  command.path_offset_mm[2] = options.path_offset_z_mm;
  while (frames.size() < options.frames) {
    const auto frame = port.read();
    if (!frame) {
      return std::unexpected(frame.error());
    }
    frames.push_back(*frame);
    if (options.ratio >= 0.0) {
      command.feed_masks_panel = frames.size() > options.from;
      command.feed_ratio = command.feed_masks_panel ? options.ratio : 1.0;
      ++command.heartbeat;
      if (auto written = port.write(command); !written) {
        return std::unexpected(written.error());
      }
    }
  }
  return frames;
}

bool save(const std::vector<signal::Frame>& frames, const std::string& name) {
  std::FILE* out = std::fopen(name.c_str(), "w");
  if (out == nullptr) {
    return false;
  }
  for (const signal::Frame& f : frames) {
    fmt::print(out, "{:.6f},{:.6f},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", f.time_s, f.age_s,
               static_cast<int>(f.motion), f.program_line, f.path_speed_mm_s,
               f.programmed_feed_mm_s, f.feed.effective_ratio, f.axis[0].command_mm,
               f.axis[1].command_mm, f.axis[0].actual_mm, f.axis[1].actual_mm,
               f.axis[0].following_error_mm, f.axis[1].following_error_mm,
               f.spindle_programmed_rev_s, f.spindle_command_rev_s, f.spindle_actual_rev_s);
  }
  return std::fclose(out) == 0;
}

int run(const Options& options) {
  const auto hal = HalProcess::make({.name = options.name,
                                     .servo_period_s = options.servo_period_s,
                                     .writes = options.ratio >= 0.0});
  if (!hal) {
    return refused(hal.error());
  }
  const auto port = LinuxCncPort::make(
      {.units = {.servo_period_s = options.servo_period_s}, .offset_slew_mm_s = 1.0}, **hal);
  if (!port) {
    return refused(port.error());
  }
  const auto frames = cycle(**port, options);
  if (!frames) {
    return refused(frames.error());
  }
  fmt::print("missed {} skipped {} rearmed {}\n", (*port)->missed(), (*port)->skipped(),
             (*port)->rearmed());
  return save(*frames, options.out) ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Reads frames from a running LinuxCNC and holds a feed ratio"};
  app.add_option("--frames", options.frames, "frames to read");
  app.add_option("--ratio", options.ratio, "feed ratio to hold; without it nothing is written");
  app.add_option("--from", options.from, "hold it from this frame on");
  app.add_option("--spindle-ratio", options.spindle_ratio, "spindle ratio to hold");
  app.add_option("--offset-z-mm", options.offset_z_mm, "offset of Z, kept when the probe dies");
  app.add_option("--path-offset-z-mm", options.path_offset_z_mm, "offset of Z, taken back then");
  app.add_option("--servo-period-s", options.servo_period_s, "[EMCMOT] SERVO_PERIOD");
  app.add_option("--name", options.name, "name of the pins");
  app.add_option("-o", options.out, "the frames")->required();
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
