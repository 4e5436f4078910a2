// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/servo_data.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// `pid.x` of `pid.x.command`
std::string instance_of(std::string_view pin) {
  return std::string(pin.substr(0, std::min(pin.rfind('.'), pin.size())));
}

class Loop {
 public:
  Loop(const IniFile& ini, const HalUse* hal, const ConfiguredAxis& axis)
      : ini_(ini), hal_(hal), joint_(axis.joints.front()) {
    if (hal_ != nullptr) {
      signals_ = hal_->signals();
    }
  }

  ServoData find() {
    if (hal_ != nullptr) {
      from_hal();
    } else {
      from_ini();
    }
    if (!out_.counts_per_unit) {
      from_scale();
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string signal_at(const std::string& pin) const {
    const auto found = signals_.find(pin);
    return found == signals_.end() ? std::string{} : found->second;
  }

  /// The first other pin of the signal with that ending.
  [[nodiscard]] std::string pin_on(const std::string& signal, std::string_view ending) const {
    for (const auto& [pin, name] : signals_) {
      if (!signal.empty() && name == signal && pin.ends_with(ending)) {
        return pin;
      }
    }
    return {};
  }

  [[nodiscard]] std::optional<ServoFigure> setting(const std::string& pin) const {
    const auto* const set = hal_->setting(pin);
    const auto value = set == nullptr ? std::nullopt : number(set->value);
    return value ? std::optional(ServoFigure{
                       *value, fmt::format("{}: setp {} {}", set->where.text(), pin, set->value)})
                 : std::nullopt;
  }

  [[nodiscard]] std::optional<ServoFigure> entry(const char* key) const {
    const auto value = ini_.number(fmt::format("JOINT_{}", joint_), key);
    if (!value || !*value) {
      return std::nullopt;
    }
    const IniEntry& at = *(*value)->entry;
    return ServoFigure{(*value)->value, fmt::format("{}:{}: {}", at.file, at.line, at.text())};
  }

  void from_hal() {
    const std::string command = signal_at(fmt::format("joint.{}.motor-pos-cmd", joint_));
    const std::string feedback = signal_at(fmt::format("joint.{}.motor-pos-fb", joint_));
    if (const std::string pid = pin_on(command, ".command"); !pid.empty()) {
      from_pid(instance_of(pid));
    } else if (const std::string step = pin_on(command, ".position-cmd"); !step.empty()) {
      no_lag(step, "a step generator in position mode follows without lag");
    } else if (!command.empty() && command == feedback) {
      looped_back_ = true;
      no_lag(fmt::format("joint.{}.motor-pos-fb", joint_), "the feedback is the command itself");
    }
    for (const char* ending : {".position", ".position-fb"}) {
      const std::string pin = pin_on(feedback, ending);
      for (const char* scale : {".scale", ".position-scale"}) {
        if (auto set = pin.empty() ? std::nullopt : setting(instance_of(pin) + scale);
            set && set->value != 0.0 && !out_.counts_per_unit) {
          out_.counts_per_unit = set;
        }
      }
    }
  }

  void from_scale() {
    for (const char* key : {"ENCODER_SCALE", "INPUT_SCALE", "STEP_SCALE", "SCALE"}) {
      auto scale = entry(key);
      if (!scale || scale->value == 0.0) {
        continue;
      }
      if (!looped_back_) {
        out_.counts_per_unit = scale;
        return;
      }
      out_.unused.push_back(scale->from + " (the HAL files have no encoder for it)");
    }
  }

  void no_lag(const std::string& pin, const char* why) {
    const Linked* const linked = hal_->linked(pin);
    out_.feed_forward = ServoFigure{
        1.0, fmt::format("{}: {}: {}", linked == nullptr ? "" : linked->where.text(), pin, why)};
  }

  [[nodiscard]] bool is_of(const char* component, const std::string& instance) const {
    const Loaded* const loaded = hal_->loaded(component);
    return loaded != nullptr &&
           (std::ranges::find(loaded->names, instance) != loaded->names.end() ||
            instance.starts_with(std::string(component) + "."));
  }

  /// Whether what is on this signal is a velocity: by where it goes.
  [[nodiscard]] bool is_velocity(const std::string& signal, int deepest) const {
    for (const auto& [pin, name] : signals_) {
      if (signal.empty() || name != signal) {
        continue;
      }
      const std::string instance = instance_of(pin);
      if (pin.ends_with(".velocity-cmd") || (pin.ends_with(".in") && is_of("integ", instance))) {
        return true;
      }
      const bool passes =
          pin.ends_with(".in") &&
          std::ranges::any_of(std::array{"lowpass", "limit1", "limit2", "limit3"},
                              [&](const char* one) { return is_of(one, instance); });
      if (passes && deepest > 0 && is_velocity(signal_at(instance + ".out"), deepest - 1)) {
        return true;
      }
    }
    return false;
  }

  void from_pid(const std::string& pid) {
    constexpr int kDeepest = 4;
    take(setting(pid + ".Pgain"), setting(pid + ".FF1"),
         is_velocity(signal_at(pid + ".output"), kDeepest));
    for (const char* pin :
         {".Igain", ".Dgain", ".FF0", ".FF2", ".deadband", ".maxoutput", ".maxerror"}) {
      if (auto set = setting(pid + pin); set && set->value != 0.0) {
        out_.unused.push_back(set->from);
      }
    }
  }

  void from_ini() {
    take(entry("P"), entry("FF1"), false);
    for (const char* key : {"I", "D", "FF0", "FF2", "DEADBAND", "MAX_OUTPUT"}) {
      if (auto value = entry(key); value && value->value != 0.0) {
        out_.unused.push_back(value->from);
      }
    }
  }

  // With FF1 = 1 the output is the commanded velocity itself: both have one unit.
  void take(const std::optional<ServoFigure>& gain, const std::optional<ServoFigure>& forward,
            bool velocity) {
    constexpr double kNear = 0.2;
    if (!gain || gain->value <= 0.0) {
      return;
    }
    if (velocity || (forward && std::abs(forward->value - 1.0) <= kNear)) {
      out_.gain_1_s = gain;
      out_.feed_forward = forward;
      return;
    }
    out_.unused.push_back(gain->from +
                          " (the loop's gain only if its output is a velocity, which "
                          "the files do not show)");
    if (forward) {
      out_.unused.push_back(forward->from);
    }
  }

  const IniFile& ini_;
  const HalUse* hal_;
  std::size_t joint_;
  bool looped_back_ = false;  ///< the feedback is the command itself
  std::map<std::string, std::string> signals_;
  ServoData out_;
};

}  // namespace

ServoData servo_data(const IniFile& ini, const HalUse* hal, const ConfiguredAxis& axis) {
  return Loop(ini, hal, axis).find();
}

}  // namespace steadyrest::adapters::linuxcnc::config
