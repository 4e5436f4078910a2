// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/limits.hpp>
#include <steadyrest/adapters/linuxcnc/config/machine_differences.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/units/convert.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::machine::Axis;
using kernel::machine::Machine;

constexpr double kSame = 1e-3;  ///< of a limit: rounding in a file

/// `X, Y, rotary A`
template <class Axes, class Describe>
std::string list(const Axes& axes, Describe describe) {
  std::string out;
  for (const auto& axis : axes) {
    const auto [name, rotary, present] = describe(axis);
    if (present) {
      out += (out.empty() ? "" : ", ") + std::string(rotary ? "rotary " : "") + name;
    }
  }
  return out.empty() ? "none" : out;
}

struct AxisWords {
  std::string name;
  bool rotary = false;
  bool present = true;
};

class Comparison {
 public:
  Comparison(const IniFile& ini, const Configuration& configuration, const Machine& machine)
      : ini_(ini), configuration_(configuration), machine_(machine) {}

  std::vector<Difference> run() {
    axes();
    periods();
    if (out_.empty()) {
      path_limits();
      spindle();
      limits();
    }
    return std::move(out_);
  }

 private:
  void differs(std::string what, std::string to_do) {
    out_.push_back({.what = std::move(what), .to_do = std::move(to_do)});
  }

  void axes() {
    const std::string ours = list(machine_.axes, [](const Axis& axis) {
      return AxisWords{.name = axis.name, .rotary = axis.rotary, .present = axis.present};
    });
    const std::string theirs = list(configuration_.axes, [](const ConfiguredAxis& axis) {
      return AxisWords{
          .name = std::string(1, axis.letter), .rotary = axis.rotary, .present = axis.present()};
    });
    if (ours != theirs) {
      differs(fmt::format("the machine file has the axes {}, LinuxCNC has {} ({})", ours, theirs,
                          ini_.path()),
              "name the machine file of this configuration");
    }
  }

  void periods() {
    const double ours_ms = 1e3 * machine_.control.servo_period_s;
    const double theirs_ms = configuration_.servo_period_ms;
    if (std::abs(ours_ms - theirs_ms) > kSame * theirs_ms) {
      differs(fmt::format("servo_period_ms is {:g}, LinuxCNC's servo period {:g} ms ({})", ours_ms,
                          theirs_ms, ini_.path()),
              fmt::format("set servo_period_ms = {:g}", theirs_ms));
    } else if (machine_.control.interpolator_period_s != machine_.control.servo_period_s) {
      differs(
          fmt::format("interpolator_period_ms is {:g}; LinuxCNC interpolates in every servo period",
                      1e3 * machine_.control.interpolator_period_s),
          fmt::format("set interpolator_period_ms = {:g}", theirs_ms));
    }
  }

  void path_limits() {
    const double mm = configuration_.mm_per_unit;
    path_limit({.what = "the path acceleration",
                .key = "max_path_acceleration_mm_s2",
                .key_unit = 1.0,
                .ours = machine_.control.max_path_acceleration_mm_s2,
                .unit = "mm/s²"},
               figure(ini_, "TRAJ", "MAX_LINEAR_ACCELERATION", mm, {0.0, 1e9, "mm/s²"}));
    path_limit({.what = "the largest feed",
                .key = "max_feed_mm_min",
                .key_unit = 60.0,
                .ours = machine_.control.max_feed_mm_s,
                .unit = "mm/s"},
               figure(ini_, "TRAJ", "MAX_LINEAR_VELOCITY", mm, {0.0, 1e9, "mm/s"}));
  }

  struct PathLimit {
    const char* what;
    const char* key;  ///< in the machine file
    double key_unit;  ///< what it counts for one of `unit`
    double ours;      ///< infinite without the key
    const char* unit;
  };

  void path_limit(const PathLimit& limit,
                  const kernel::outcome::Result<std::optional<Figure>>& theirs) {
    if (!theirs || !*theirs || limit.ours <= (*theirs)->value * (1.0 + kSame)) {
      return;
    }
    const Figure& figure = **theirs;
    if (!std::isfinite(limit.ours)) {
      differs(fmt::format("the machine file sets no {}; the control's is {:g} {} ({})", limit.key,
                          figure.value, limit.unit, figure.from),
              fmt::format("set {} = {:g}, or less", limit.key, limit.key_unit * figure.value));
      return;
    }
    differs(fmt::format("{} {:g} {} in the machine file is beyond the control's {:g} ({})",
                        limit.what, limit.ours, limit.unit, figure.value, figure.from),
            "take the control's figure, or less");
  }

  /// The layer's factor acts behind LinuxCNC's own limit of the speed.
  void spindle() {
    const double ours_rpm = 60.0 * machine_.spindle.max_rev_s;
    const auto theirs = figure(ini_, "SPINDLE_0", "MAX_FORWARD_VELOCITY", 1.0, {0.0, 1e9, "rpm"});
    if (theirs && *theirs && ours_rpm > (*theirs)->value * (1.0 + kSame)) {
      differs(fmt::format("the spindle's largest speed, {:g} rpm in the machine file, is beyond "
                          "the control's {:g} ({})",
                          ours_rpm, (*theirs)->value, (*theirs)->from),
              fmt::format("set max_rpm = {:g}, or less", (*theirs)->value));
    }
  }

  void limits() {
    std::size_t i = 0;
    for (const ConfiguredAxis& theirs : configuration_.axes) {
      if (!theirs.present()) {
        continue;
      }
      while (!machine_.axes[i].present) {
        ++i;
      }
      if (const auto limits = limits_of(ini_, configuration_, theirs); limits) {
        limits_of_axis(machine_.axes[i], *limits);
      } else {
        differs(limits.error().what, limits.error().to_do);
      }
      ++i;
    }
  }

  void limits_of_axis(const Axis& ours, const AxisLimits& theirs) {
    const double unit = ours.rotary ? kernel::units::rad_from_deg(1.0) : 1.0;
    const char* const name = ours.rotary ? "°" : "mm";
    beyond(ours, "speed", ours.max_speed_au_s / unit, theirs.speed_units_s,
           fmt::format("{}/s", name));
    beyond(ours, "acceleration", ours.max_acceleration_au_s2 / unit, theirs.acceleration_units_s2,
           fmt::format("{}/s²", name));
    if (theirs.min) {
      end(ours, "lower", ours.min_au / unit, *theirs.min, -1.0, name);
    }
    if (theirs.max) {
      end(ours, "upper", ours.max_au / unit, *theirs.max, 1.0, name);
    }
  }

  void beyond(const Axis& axis, const char* what, double ours, const Figure& theirs,
              const std::string& unit) {
    if (ours > theirs.value * (1.0 + kSame)) {
      is_beyond(axis, what, ours, theirs, unit);
    }
  }

  void end(const Axis& axis, const char* which, double ours, const Figure& theirs, double sign,
           const char* unit) {
    if (sign * (ours - theirs.value) > kSame) {
      is_beyond(axis, fmt::format("{} end of travel", which), ours, theirs, unit);
    }
  }

  void is_beyond(const Axis& axis, const std::string& what, double ours, const Figure& theirs,
                 const std::string& unit) {
    differs(fmt::format("axis {}: {} {:g} {} in the machine file is beyond the control's {:g} ({})",
                        axis.name, what, ours, unit, theirs.value, theirs.from),
            "take the control's figure, or less");
  }

  const IniFile& ini_;
  const Configuration& configuration_;
  const Machine& machine_;
  std::vector<Difference> out_;
};

bool same_limits(const Axis& one, const Axis& other) {
  return one.max_speed_au_s == other.max_speed_au_s &&
         one.max_acceleration_au_s2 == other.max_acceleration_au_s2 &&
         one.max_jerk_au_s3 == other.max_jerk_au_s3;
}

}  // namespace

std::optional<Difference> changed_since_start(const Machine& running, const Machine& wanted) {
  std::string what;
  if (wanted.envelope.offset_slew_mm_s != running.envelope.offset_slew_mm_s) {
    what = "[envelope] offset_slew_um_s";
  } else if (wanted.control != running.control) {
    what = "[control]";
  } else if (!std::ranges::equal(wanted.axes, running.axes, same_limits)) {
    what = "an axis's speed, acceleration or jerk limit";
  } else {
    return std::nullopt;
  }
  return Difference{
      .what = what + " differs from the running layer's: on LinuxCNC it cannot change during a run",
      .to_do = "stop the layer and start it with the new file"};
}

std::vector<Difference> differences(const IniFile& ini, const Configuration& configuration,
                                    const Machine& machine) {
  return Comparison(ini, configuration, machine).run();
}

}  // namespace steadyrest::adapters::linuxcnc::config
