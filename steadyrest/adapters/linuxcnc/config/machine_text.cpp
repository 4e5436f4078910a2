// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/limits.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/program_section.hpp>
#include <steadyrest/adapters/linuxcnc/config/servo_data.hpp>

// Each line names the entry that it is from, so that a reader can check it against the INI file.
namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::outcome::Result;

class Writer {
 public:
  Writer(const IniFile& ini, const Configuration& machine, const HalUse* hal,
         const std::string& hal_unread)
      : ini_(ini), machine_(machine), hal_(hal), hal_unread_(hal_unread) {}

  Result<MachineText> write() {
    head();
    for (const auto part :
         {&Writer::control, &Writer::axes, &Writer::overrides, &Writer::spindle}) {
      if (auto done = (this->*part)(); !done) {
        return std::unexpected(done.error());
      }
    }
    layer();
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_.text += text + "\n"; }
  void noted(const std::string& assignment, const std::string& comment) {
    line(fmt::format("{:<31} # {}", assignment, comment));
  }
  void given(const char* key, double value, const std::string& from,
             const std::string& where = {}) {
    const std::string text = fmt::format("{:.10g}", value);
    noted(fmt::format("{} = {}", key, text), comment_of(from));
    ++out_.from_ini;
    out_.values.push_back({.key = section_ + key,
                           .value = text,
                           .from = where.empty() ? from : fmt::format("{}: {}", where, from)});
  }
  /// A figure in the key's unit, `scale` of the figure's own.
  void given(const char* key, const Figure& figure, double scale = 1.0) {
    clip(figure);
    given(key, figure.value * scale, figure.from, figure.where);
  }
  void clip(const std::optional<Figure>& figure) {
    if (figure && !figure->clipped.empty()) {
      line("# " + comment_of(figure->clipped));
      out_.clipped.push_back(figure->clipped);
    }
  }
  void assumed(const char* key, double value, const char* measure) {
    noted(fmt::format("{} = {:.10g}", key, value), fmt::format("ASSUMED: {}", measure));
    ++out_.assumed;
  }
  /// A key of the INI file, or a comment that says why it is missing.
  Result<void> optional(const char* key, const char* section, const char* ini_key, double factor,
                        const Range& range, double scale, const char* without) {
    const auto value = figure(ini_, section, ini_key, factor, range);
    if (!value) {
      return std::unexpected(value.error());
    }
    if (*value) {
      given(key, **value, scale);
    } else {
      line(fmt::format("# {}: no [{}] {}; {}", key, section, ini_key, without));
    }
    return {};
  }
  /// A planner setting with LinuxCNC's own default.
  Result<void> setting(const char* key, const char* ini_key, double factor, double least,
                       double most, double by_default) {
    const auto value = figure(ini_, "TRAJ", ini_key, factor, {least, most, ""});
    if (!value) {
      return std::unexpected(value.error());
    }
    if (*value) {
      given(key, **value);
    } else {
      given(key, by_default * factor,
            fmt::format("[TRAJ] {} is missing: LinuxCNC takes {:g}", ini_key, by_default));
    }
    return {};
  }

  void head() {
    line(fmt::format("# Made by `steadyrest machine from-linuxcnc` from {}.",
                     comment_of(std::filesystem::path(ini_.path()).filename().string())));
    line(
        "# Lines with ASSUMED hold what no INI file says: measure it, put the value in, delete the "
        "word.");
    line(
        "# `steadyrest doctor --machine FILE` checks the result; port = \"sim\" tries it without "
        "the machine.");
    constexpr std::size_t kLongestName = 80;
    line(fmt::format("name = {}", machine_.name.empty()
                                      ? "\"LinuxCNC machine\""
                                      : toml_string(machine_.name, kLongestName)));
    line("port = \"linuxcnc\"");
    line("mode = \"observe\"");
  }

  Result<void> control() {
    section_ = "control.";
    line("\n[control]");
    line("dialect = \"linuxcnc\"");
    line(fmt::format("units = \"{}\"  # {}", machine_.mm_per_unit == 1.0 ? "mm" : "inch",
                     comment_of(ini_.find("TRAJ", "LINEAR_UNITS")->text())));
    const IniEntry& entry = *ini_.find("EMCMOT", "SERVO_PERIOD");
    const std::string period = entry.text() + " ns";
    const std::string where = fmt::format("{}:{}", entry.file, entry.line);
    given("interpolator_period_ms", machine_.servo_period_ms, period, where);
    given("servo_period_ms", machine_.servo_period_ms, period, where);
    const double mm = machine_.mm_per_unit;
    if (auto done = optional("max_path_acceleration_mm_s2", "TRAJ", "MAX_LINEAR_ACCELERATION", mm,
                             {1.0, 1e6, "mm/s²"}, 1.0, "the axes' own limits count");
        !done) {
      return done;
    }
    // It limits rapids as well.
    for (const char* key : {"max_feed_mm_min", "rapid_mm_min"}) {
      if (auto done =
              optional(key, "TRAJ", "MAX_LINEAR_VELOCITY", mm, {1.0 / 60.0, 1e6 / 60.0, "mm/s"},
                       60.0, "the axes' own limits count");
          !done) {
        return done;
      }
    }
    // Two lines meet in one arc, so the depth counts both.
    if (auto done =
            setting("look_ahead_blocks", "ARC_BLEND_OPTIMIZATION_DEPTH", 2.0, 1.0, 10000.0, 50.0);
        !done) {
      return done;
    }
    assumed("tool_change_s", 5.0, "time a tool change");
    return planner();
  }

  /// The laws of LinuxCNC's planner do not depend on the machine; two of them have settings.
  Result<void> planner() {
    const auto enabled = figure(ini_, "TRAJ", "ARC_BLEND_ENABLE", 1.0, {-1e9, 1e9, ""});
    if (!enabled) {
      return std::unexpected(enabled.error());
    }
    line("# The laws of LinuxCNC's trajectory planner, measured on version 2.9.");
    if (*enabled && (*enabled)->value == 0.0) {
      line(
          "# [TRAJ] ARC_BLEND_ENABLE = 0: without arcs at corners; these laws are then an "
          "estimate.");
    }
    if (auto done = setting("junction_share", "ARC_BLEND_KINK_RATIO", 1.0, 0.001, 1.0, 0.1);
        !done) {
      return done;
    }
    if (auto done = setting("blend_gap_cycles", "ARC_BLEND_GAP_CYCLES", 1.0, 0.0, 1000.0, 4.0);
        !done) {
      return done;
    }
    const auto laws = planner_laws(ini_, machine_.mm_per_unit);
    if (!laws) {
      return std::unexpected(laws.error());
    }
    add(*laws);
    add(program_section(ini_, machine_, hal_unread_));
    return {};
  }

  void add(ProgramSection made) {
    out_.text += made.text;
    out_.from_ini += made.values.size();
    std::ranges::move(made.values, std::back_inserter(out_.values));
    std::ranges::move(made.not_carried, std::back_inserter(out_.not_carried));
  }

  Result<void> axes() {
    for (const ConfiguredAxis& axis : machine_.axes) {
      if (auto done = axis.present() ? one_axis(axis) : Result<void>{}; !done) {
        return done;
      }
    }
    return {};
  }

  Result<void> one_axis(const ConfiguredAxis& axis) {
    const auto limits = limits_of(ini_, machine_, axis);
    if (!limits) {
      return std::unexpected(limits.error());
    }
    line("\n[[axis]]");
    std::string joints;
    for (const std::size_t joint : axis.joints) {
      joints += fmt::format("{}{}", joints.empty() ? "" : " and ", joint);
    }
    noted(fmt::format("name = \"{}\"", axis.letter),
          fmt::format("joint {}{}", joints,
                      axis.joints.size() > 1 ? "; the layer reads the first" : ""));
    section_ = fmt::format("axis.{}.", axis.letter);
    const ServoData servo = servo_data(ini_, hal_, axis);
    position_loop(servo);
    const bool rotary = axis.rotary;
    given(rotary ? "max_speed_deg_s" : "max_feed_mm_min", limits->speed_units_s,
          rotary ? 1.0 : 60.0);
    if (!limits->slower_joint.empty()) {
      line(fmt::format("# {} is lower; LinuxCNC plans with the axis's.",
                       comment_of(limits->slower_joint)));
    }
    given(rotary ? "max_acceleration_deg_s2" : "max_acceleration_mm_s2",
          limits->acceleration_units_s2);
    end(rotary ? "min_deg" : "min_mm", limits->min);
    end(rotary ? "max_deg" : "max_mm", limits->max);
    line("[axis.encoder]");
    count(servo, rotary);
    return {};
  }

  void position_loop(const ServoData& servo) {
    if (servo.gain_1_s) {
      found("servo_gain_1_s", *servo.gain_1_s, servo.gain_1_s->value, {1.0, 1000.0, ""});
    } else {
      assumed("servo_gain_1_s", 20.0,
              "`steadyrest machine from-log` finds it from a record of a test program");
    }
    if (servo.feed_forward) {
      found("feed_forward", *servo.feed_forward, servo.feed_forward->value, {0.0, 1.5, ""});
    }
    line("# velocity_lag_ms: not in these files; `steadyrest machine from-log` fits it");
    for (const std::string& unused : servo.unused) {
      line("# not carried: " + comment_of(unused));
      out_.not_carried.push_back(unused);
    }
  }

  void count(const ServoData& servo, bool rotary) {
    const char* const key = rotary ? "count_deg" : "count_um";
    section_ += "encoder.";
    if (servo.counts_per_unit) {
      const double unit = rotary ? machine_.deg_per_unit : 1e3 * machine_.mm_per_unit;
      found(key, *servo.counts_per_unit, unit / std::abs(servo.counts_per_unit->value),
            {0.0, rotary ? 10.0 : 1000.0, ""});
    } else {
      assumed(key, rotary ? 0.001 : 1.0,
              "1 / counts per unit of the encoder (or step) scale in the HAL files");
    }
  }

  /// A value made of a servo figure, within what a machine file takes.
  void found(const char* key, const ServoFigure& figure, double value, const Range& range) {
    const double taken = std::clamp(value, range.least, range.most);
    const auto clipped = fmt::format("{}: {} would be {:g}: {:g} is taken, the nearest allowed",
                                     figure.from, key, value, taken);
    given(key, {.value = taken,
                .from = figure.from,
                .where = {},
                .clipped = taken == value ? std::string{} : clipped});
  }

  void end(const char* key, const std::optional<Figure>& value) {
    if (value) {
      given(key, *value);
    } else {
      line(fmt::format("# {}: the INI file sets no limit", key));
    }
  }

  Result<void> overrides() {
    const auto most = figure(ini_, "DISPLAY", "MAX_FEED_OVERRIDE", 100.0, {-1e9, 1000.0, "%"});
    if (!most) {
      return std::unexpected(most.error());
    }
    clip(*most);
    line(
        "\n# motion.adaptive-feed (after M52 P1): a number that acts in the same servo cycle. 2.9 "
        "clamps it to 100 %, so");
    line("# the layer can only lower the feed" +
         (*most ? fmt::format("; the panel goes to {:.10g} % ({}).", (*most)->value,
                              comment_of((*most)->from))
                : std::string(".")));
    line("[override.feed]");
    line("coding = \"binary\"");
    line("binary_max_percent = 100");
    line("binary_step_percent = 0.5");
    line(fmt::format("scan_period_ms = {:.10g}", machine_.servo_period_ms));
    line("dead_time_ms = 1");
    line("latched_word = true");
    line("max_percent = 100");
    return spindle_override();
  }

  Result<void> spindle_override() {
    const Range range{-1e9, 1000.0, "%"};
    const auto least = figure(ini_, "DISPLAY", "MIN_SPINDLE_OVERRIDE", 100.0, range);
    const auto most = least ? figure(ini_, "DISPLAY", "MAX_SPINDLE_OVERRIDE", 100.0, range)
                            : std::unexpected(least.error());
    if (!most) {
      return std::unexpected(most.error());
    }
    clip(*least);
    clip(*most);
    // 100 % is always a step: it is what the program says.
    const double low = std::clamp(std::ceil(*least ? (*least)->value : 50.0), 0.0, 100.0);
    const double high = std::max(100.0, std::floor(*most ? (*most)->value : 100.0));
    low_percent_ = low;
    high_percent_ = std::min(high, 200.0);
    std::string steps = fmt::format("{:g}", low);
    for (double at = (std::floor(low / 5.0) + 1.0) * 5.0; at < high_percent_; at += 5.0) {
      steps += fmt::format(", {:g}", at);
    }
    steps += low < high_percent_ ? fmt::format(", {:g}", high_percent_) : "";
    line(
        "\n# The spindle's factor in the layer's HAL file, 0 ... 200 %, within the panel's range:");
    line(*least ? "# " + comment_of((*least)->from)
                : "# [DISPLAY] MIN_SPINDLE_OVERRIDE is missing: from 50 %");
    line(*most ? "# " + comment_of((*most)->from)
               : "# [DISPLAY] MAX_SPINDLE_OVERRIDE is missing: LinuxCNC takes 1");
    line("[override.spindle]");
    line("coding = \"binary\"");
    line(fmt::format("percent = [{}]", steps));
    noted("scan_period_ms = 20", "halui's loop");
    line("dead_time_ms = 1");
    line(fmt::format("max_percent = {:g}", high_percent_));
    out_.from_ini += 2;
    return {};
  }

  Result<void> spindle() {
    section_ = "spindle.";
    line("\n[spindle]");
    const auto most = figure(ini_, "SPINDLE_0", "MAX_FORWARD_VELOCITY", 1.0, {1.0, 1e6, "rpm"});
    const auto least = most ? figure(ini_, "SPINDLE_0", "MIN_FORWARD_VELOCITY", 1.0,
                                     {0.0, *most ? (*most)->value : 1e6, "rpm"})
                            : std::unexpected(most.error());
    if (!least) {
      return std::unexpected(least.error());
    }
    if (*least) {
      given("min_rpm", **least);
    } else {
      line("min_rpm = 0");
    }
    if (*most) {
      given("max_rpm", **most);
    } else {
      assumed("max_rpm", std::max(24000.0, *least ? (*least)->value : 0.0),
              "no [SPINDLE_0] MAX_FORWARD_VELOCITY; the fastest the spindle may turn");
    }
    assumed("acceleration_rpm_s", 8000.0,
            "speed / time of a run-up (halscope on the spindle's speed)");
    assumed("inertia_kg_m2", 0.0004, "the maker's data of rotor, chuck and tool");
    assumed("rated_power_kw", 2.2, "the motor's plate");
    assumed("max_torque_n_m", 1.2, "the motor's plate");
    return {};
  }

  void layer() {
    line("\n[contour]");
    line("strategy = \"feed_priority\"");
    assumed("limit_um", 10.0, "the contour error that your parts permit");
    line("min_percent = 5");
    line("max_percent = 100");
    line("\n[envelope]");
    line("max_feed_percent = 100");
    line("feed_fall_percent_s = 10000");
    line("feed_rise_percent_s = 500");
    line(fmt::format("min_spindle_percent = {:g}", low_percent_));
    line(fmt::format("max_spindle_percent = {:g}", high_percent_));
    line("stale_after_ms = 20");
  }

  const IniFile& ini_;
  const Configuration& machine_;
  const HalUse* hal_;
  const std::string& hal_unread_;
  std::string section_;  ///< of the keys being written, `axis.X.`
  MachineText out_;
  double low_percent_ = 50.0;
  double high_percent_ = 100.0;
};

}  // namespace

Result<MachineText> machine_text(const IniFile& ini, const Configuration& machine,
                                 const HalUse* hal, const std::string& hal_unread) {
  return Writer(ini, machine, hal, hal_unread).write();
}

}  // namespace steadyrest::adapters::linuxcnc::config
