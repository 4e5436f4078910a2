// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/hal_lines.hpp>
#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>
#include <steadyrest/adapters/linuxcnc/sample.hpp>

// The one source of the layer's HAL text: layer.hal and layer_offsets.hal are its output for three
// axes with nothing in the way.
namespace steadyrest::adapters::linuxcnc::config {
namespace {

/// Linear, and with a joint: LinuxCNC offsets it.
bool moves(const LayerAxis& axis) {
  return axis.joint && !axis.rotary;
}

char lower(char letter) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
}

std::size_t axis_channels(const LayerHal& layer) {
  return (layer.axes.size() + kAxesPerChannel - 1) / kAxesPerChannel;
}

std::string of_axis(const char* stem, const LayerAxis& axis) {
  return fmt::format("layer.{}-{}", stem, lower(axis.letter));
}

/// Without an exponent, which halcmd's readers need not know.
std::string decimal(double value) {
  std::string out = fmt::format("{:.10f}", value);
  return out.erase(out.find_last_not_of('0') + 1);
}

/// `speed-out-rps` has the name that the first version had.
std::string drive_name(const std::string& output) {
  if (output == "speed-out-rps") {
    return "layer.drive";
  }
  return output == "speed-out" ? "layer.drive-rpm" : "layer.drive" + output.substr(9);
}

std::string sampler_arguments(const LayerHal& layer) {
  std::string depth = "depth=4000";
  std::string types = fmt::format("cfg={}", kStateTypes);
  std::size_t left = layer.axes.size();
  for (std::size_t i = 0; i < axis_channels(layer); ++i) {
    const std::size_t here = std::min(left, kAxesPerChannel);
    left -= here;
    depth += ",4000";
    types += "," + std::string(1 + kAxisColumns * here, 'f');
  }
  return depth + " " + types;
}

void load(HalLines& text, const LayerHal& layer) {
  for (const Needed& one : needed(layer)) {
    if (layer.loaded.contains(one.component) || one.component == "conv_float_s32") {
      continue;
    }
    std::string names;
    for (const std::string& name : one.names) {
      names += (names.empty() ? "names=" : ",") + name;
    }
    text.line(fmt::format("loadrt {} {}{}", one.component, one.arguments, names));
  }
  text.line();
}

void run(HalLines& text, const LayerHal& layer) {
  text.line(
      "# Before the motion controller, so that a ratio acts in the servo cycle that finds it.");
  text.addf("watchdog.set-timeouts", 1);
  text.addf("watchdog.process", 2);
  int position = 3;
  for (const char* name :
       {"layer.held", "layer.rate", "layer.feed-choice", "layer.feed-falls", "layer.feed-ramp",
        "layer.feed-panel-on", "layer.feed-panel", "layer.feed-share", "layer.feed-most",
        "layer.spindle-choice", "layer.spindle-ramp"}) {
    text.addf(name, position++);
  }
  text.line("# After it: the drive's speed, the cycle's number, the samples.");
  text.addf("layer.drive");
  for (const std::string& output : layer.drives) {
    text.addf(drive_name(output));
  }
  text.addf("layer.tick");
  for (std::size_t i = 0; i <= axis_channels(layer); ++i) {
    text.addf(fmt::format("sampler.{}", i));
  }
  text.line();
}

/// What the servo thread thinks of the layer: alive, late, dead.
void life(HalLines& text) {
  text.line(
      "# No heartbeat for 20 ms: the layer is late. Path offsets go; feed and spindle stay as they "
      "are. Only a disarmed and\n# armed watchdog makes it alive again.");
  text.setp("watchdog.timeout-0", "0.020");
  text.reads("layer-armed", {"watchdog.enable-in"});
  text.net("layer-alive", "watchdog.ok-out", {"layer.rate.sel", "sampler.0.pin.14"});
  text.line(
      "\n# No heartbeat for layer-hold seconds: it is dead, and feed and spindle return by "
      "layer-rise 1/s. The layer's process\n# gives both: [envelope] late_hold_ms, and the slower "
      "of its feed_rise and spindle_slew.");
  text.setp("layer.held.falling", "1");
  text.setp("layer.rate.in1", "15.0");
  text.reads("layer-hold", {"layer.held.width"});
  text.reads("layer-rise", {"layer.rate.in0"});
  text.line("sets layer-hold 1.0\nsets layer-rise 2.0");
  text.reads("layer-heartbeat", {"watchdog.input-0", "layer.held.in"});
  text.net("layer-held", "layer.held.out", {"layer.feed-choice.sel", "layer.spindle-choice.sel"});
  text.net("layer-rate", "layer.rate.out", {"layer.feed-ramp.maxv", "layer.spindle-ramp.maxv"});
}

void ratios(HalLines& text, const LayerHal& layer) {
  text.line(
      "\n# Feed: a ceiling that falls at once and rises by the rate, 15 1/s at most; 10 is none. "
      "The "
      "pin gets ceiling / panel, 1 at\n# most: in force is the lower of both, whether or not the "
      "layer lives. At panel 0 as for panel 1.");
  text.setp("layer.feed-choice.in0", fmt::format("{:.1f}", kNoCeiling));
  text.setp("layer.feed-ramp.min", "0.0");
  text.setp("layer.feed-ramp.max", fmt::format("{:.1f}", kNoCeiling));
  text.setp("layer.feed-panel.in0", "1.0");
  text.setp("layer.feed-most.min", "0.0");
  text.setp("layer.feed-most.max", "1.0");
  text.reads("layer-feed", {"layer.feed-choice.in1"});
  text.net("layer-feed-chosen", "layer.feed-choice.out",
           {"layer.feed-ramp.in", "layer.feed-falls.in0"});
  text.net("layer-feed-falls", "layer.feed-falls.out", {"layer.feed-ramp.load"});
  text.net("layer-feed-ceiling", "layer.feed-ramp.out",
           {"layer.feed-falls.in1", "layer.feed-share.in0"});
  text.net("layer-feed-panel-on", "layer.feed-panel-on.out", {"layer.feed-panel.sel"});
  text.net("layer-feed-divisor", "layer.feed-panel.out", {"layer.feed-share.in1"});
  text.net("layer-feed-share", "layer.feed-share.out", {"layer.feed-most.in"});
  text.net("layer-feed-in-force", "layer.feed-most.out",
           {"motion.adaptive-feed", "sampler.0.pin.12"});
  text.line(
      "\n# Spindle: the drive gets speed-out × ratio. Connect layer-drive-rps to it instead of "
      "spindle.0.speed-out-rps.");
  text.setp("layer.spindle-choice.in0", "1.0");
  text.setp("layer.spindle-ramp.min", "0.0");
  text.setp("layer.spindle-ramp.max", "2.0");
  text.reads("layer-spindle", {"layer.spindle-choice.in1"});
  text.net("layer-spindle-chosen", "layer.spindle-choice.out", {"layer.spindle-ramp.in"});
  std::vector<std::string> factors{"layer.drive.in1"};
  for (const std::string& output : layer.drives) {
    factors.push_back(drive_name(output) + ".in1");
  }
  factors.emplace_back("sampler.0.pin.13");
  text.net("layer-spindle-in-force", "layer.spindle-ramp.out", factors);
  text.net("layer-spindle-rps", "spindle.0.speed-out-rps", {"layer.drive.in0", "sampler.0.pin.6"});
  text.net("layer-drive-rps", "layer.drive.out", {});
  for (const std::string& output : layer.drives) {
    text.net("layer-spindle" + output.substr(5), "spindle.0." + output,
             {drive_name(output) + ".in0"});
    text.net(drive_signal(output), drive_name(output) + ".out", {});
  }
  text.line();
}

void state_samples(HalLines& text) {
  struct Row {
    const char* signal;
    const char* source;
    int pin;
  };
  static constexpr Row kRows[] = {
      {"layer-motion-type", "motion.motion-type", 1},
      {"layer-program-line", "motion.program-line", 2},
      {"layer-path-speed", "motion.current-vel", 3},
      {"layer-requested", "motion.requested-vel", 4},
      {"layer-feed-mm-s", "motion.feed-mm-per-second", 5},
      {"layer-enabled", "motion.motion-enabled", 8},
      {"layer-feed-panel", "halui.feed-override.value", 9},
      {"layer-spindle-panel", "halui.spindle.0.override.value", 10},
      {"layer-rapid-panel", "halui.rapid-override.value", 11},
      {"layer-is-auto", "halui.mode.is-auto", 15},
      {"layer-is-running", "halui.program.is-running", 16},
      {"layer-is-paused", "halui.program.is-paused", 17},
      // M64 P0 and M65 P0 in the program switch the modulation of the spindle's speed on and off.
      {"layer-modulation", "motion.digital-out-00", 18},
  };
  for (const Row& row : kRows) {
    std::vector<std::string> readers{fmt::format("sampler.0.pin.{}", row.pin)};
    if (row.pin == 9) {
      readers.insert(readers.end(), {"layer.feed-panel-on.in1", "layer.feed-panel.in1"});
    }
    text.net(row.signal, row.source, readers);
  }
}

void samples(HalLines& text, const LayerHal& layer) {
  text.line("# The number of the servo cycle, in each channel: samples are joined by it.");
  text.setp("layer.tick.in0", "1.0");
  std::vector<std::string> ticks{"layer.tick.in1"};
  for (std::size_t i = 0; i <= axis_channels(layer); ++i) {
    ticks.push_back(fmt::format("sampler.{}.pin.0", i));
  }
  text.net("layer-tick", "layer.tick.out", ticks);
  text.line("\n# Millimetres in one of the machine's units.");
  text.line("newsig layer-unit-mm float");
  text.line(fmt::format("sets layer-unit-mm {:.10g}", layer.mm_per_unit));
  text.line();
  state_samples(text);
  text.line("# Columns of an axis: command, actual position, following error, offset.");
  for (std::size_t i = 0; i < layer.axes.size(); ++i) {
    const LayerAxis& axis = layer.axes[i];
    if (!axis.joint) {
      text.line(fmt::format("# No joint for {}: its columns stay 0.", axis.letter));
      continue;
    }
    const char l = lower(axis.letter);
    const std::string joint = fmt::format("joint.{}.", *axis.joint);
    const auto column = [&](std::size_t k) {
      return fmt::format("sampler.{}.pin.{}", 1 + i / kAxesPerChannel,
                         1 + kAxisColumns * (i % kAxesPerChannel) + k);
    };
    text.net(fmt::format("layer-{}-command", l), joint + "pos-cmd", {column(0)});
    text.net(fmt::format("layer-{}-actual", l), joint + "pos-fb", {column(1)});
    text.net(fmt::format("layer-{}-lag", l), joint + "f-error", {column(2)});
    text.net(fmt::format("layer-{}-eoffset", l), fmt::format("axis.{}.eoffset", l), {column(3)});
  }
  const auto measured = layer.signal.find("spindle.0.speed-in");
  if (measured != layer.signal.end()) {
    text.line("# The spindle's measured speed.");
    text.reads(measured->second, {"sampler.0.pin.7"});
  } else {
    text.line(
        "# sampler.0.pin.7 takes the spindle's measured speed: the signal that goes to "
        "spindle.0.speed-in.");
  }
}

void load_offsets(HalLines& text, const LayerHal& layer) {
  const auto counts = needed(layer).back();
  if (!layer.loaded.contains(counts.component)) {
    std::string names;
    for (const std::string& name : counts.names) {
      names += (names.empty() ? "" : ",") + name;
    }
    text.line(fmt::format("loadrt {} names={}\n", counts.component, names));
  }
  int position = 14;
  for (const LayerAxis& axis : layer.axes) {
    for (const char* stem : {"path", "path-ramp", "offset", "counts"}) {
      if (moves(axis)) {
        text.addf(of_axis(stem, axis), position++);
      }
    }
  }
  text.line(
      fmt::format("\n# The sum goes out in counts of {:g} machine units. When the heartbeat stops, "
                  "the path offset returns to 0 at\n"
                  "# {:g} machine units/s; the offset against heat stays.",
                  layer.offset_count, layer.path_ramp_units_s));
}

void offset(HalLines& text, const LayerHal& layer, std::size_t i) {
  const LayerAxis& axis = layer.axes[i];
  const char l = lower(axis.letter);
  const std::string gain = fmt::format("{:.10g}", 1.0 / layer.offset_count);
  text.line();
  text.setp(of_axis("path-ramp", axis) + ".maxv", fmt::format("{:.10g}", layer.path_ramp_units_s));
  text.setp(of_axis("offset", axis) + ".gain0", gain);
  text.setp(of_axis("offset", axis) + ".gain1", gain);
  text.setp(fmt::format("axis.{}.eoffset-scale", l), decimal(layer.offset_count));
  text.setp(fmt::format("axis.{}.eoffset-enable", l), "1");
  const char upper = axis.letter;
  text.line(
      fmt::format("newsig layer-offset-share-{0} float\nnewsig layer-axis-acceleration-{0} float\n"
                  "sets layer-offset-share-{0} [AXIS_{1}]OFFSET_AV_RATIO\n"
                  "sets layer-axis-acceleration-{0} [AXIS_{1}]MAX_ACCELERATION",
                  i, upper));
  text.reads(fmt::format("layer-path-offset-{}", i), {of_axis("path", axis) + ".in1"});
  text.reads("layer-alive", {of_axis("path", axis) + ".sel", of_axis("path-ramp", axis) + ".load"});
  text.net(fmt::format("layer-path-{}-chosen", l), of_axis("path", axis) + ".out",
           {of_axis("path-ramp", axis) + ".in"});
  text.net(fmt::format("layer-path-{}-in-force", l), of_axis("path-ramp", axis) + ".out",
           {of_axis("offset", axis) + ".in1"});
  text.reads(fmt::format("layer-offset-{}", i), {of_axis("offset", axis) + ".in0"});
  text.net(fmt::format("layer-offset-{}-counts-float", l), of_axis("offset", axis) + ".out",
           {of_axis("counts", axis) + ".in"});
  text.net(fmt::format("layer-offset-{}-counts", l), of_axis("counts", axis) + ".out",
           {fmt::format("axis.{}.eoffset-counts", l)});
}

}  // namespace

std::string drive_signal(const std::string& output) {
  return output == "speed-out" ? "layer-drive-rpm" : "layer-drive" + output.substr(9);
}

std::vector<Needed> needed(const LayerHal& layer) {
  Needed sums{"sum2", {"layer.tick"}, ""};
  Needed choices{
      "mux2", {"layer.rate", "layer.feed-choice", "layer.feed-panel", "layer.spindle-choice"}, ""};
  Needed ramps{"limit2", {"layer.feed-ramp", "layer.feed-most", "layer.spindle-ramp"}, ""};
  Needed drives{"mult2", {"layer.drive"}, ""};
  Needed counts{"conv_float_s32", {}, ""};
  for (const std::string& output : layer.drives) {
    drives.names.push_back(drive_name(output));
  }
  for (const LayerAxis& axis : layer.axes) {
    if (layer.offset_components && moves(axis)) {
      sums.names.push_back(of_axis("offset", axis));
      choices.names.push_back(of_axis("path", axis));
      ramps.names.push_back(of_axis("path-ramp", axis));
      counts.names.push_back(of_axis("counts", axis));
    }
  }
  std::vector<Needed> out{sums,
                          {"watchdog", {}, "num_inputs=1"},
                          {"oneshot", {"layer.held"}, ""},
                          choices,
                          {"comp", {"layer.feed-falls", "layer.feed-panel-on"}, ""},
                          {"div2", {"layer.feed-share"}, ""},
                          ramps,
                          drives,
                          {"sampler", {}, sampler_arguments(layer)}};
  if (layer.offset_components) {
    out.push_back(counts);
  }
  return out;
}

std::vector<std::string> driven_pins(const LayerHal& layer, bool offsets) {
  std::vector<std::string> out{"motion.adaptive-feed"};
  for (const LayerAxis& axis : layer.axes) {
    if (offsets && moves(axis)) {
      for (const char* pin : {"counts", "enable", "scale", "clear"}) {
        out.push_back(fmt::format("axis.{}.eoffset-{}", lower(axis.letter), pin));
      }
    }
  }
  return out;
}

std::string layer_text(const LayerHal& layer) {
  HalLines text(layer);
  load(text, layer);
  run(text, layer);
  life(text);
  ratios(text, layer);
  samples(text, layer);
  return text.take();
}

std::string offsets_text(const LayerHal& layer) {
  HalLines text(layer);
  load_offsets(text, layer);
  for (std::size_t i = 0; i < layer.axes.size(); ++i) {
    if (moves(layer.axes[i])) {
      offset(text, layer, i);
    } else {
      // The layer's process connects its pins for every axis.
      text.line(fmt::format(
          "\nnewsig layer-offset-{0} float\nnewsig layer-path-offset-{0} float\n"
          "newsig layer-offset-share-{0} float\nnewsig layer-axis-acceleration-{0} float",
          i));
    }
  }
  return text.take();
}

}  // namespace steadyrest::adapters::linuxcnc::config
