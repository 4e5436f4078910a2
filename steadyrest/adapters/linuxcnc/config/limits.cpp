// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/limits.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr double kNoLimit_mm = 1e6;   ///< the most a machine file takes; LinuxCNC's "none" is 1e99
constexpr double kNoLimit_deg = 1e8;  ///< the same for a rotary axis

constexpr Range kSpeed_mm_s{1.0 / 60.0, 1e6 / 60.0, "mm/s"};
constexpr Range kSpeed_deg_s{0.01, 1e5, "°/s"};
constexpr Range kAcceleration_mm_s2{1.0, 1e6, "mm/s²"};
constexpr Range kAcceleration_deg_s2{0.1, 1e6, "°/s²"};

double factor_of(const Configuration& machine, const ConfiguredAxis& axis) {
  return axis.rotary ? machine.deg_per_unit : machine.mm_per_unit;
}

/// LinuxCNC takes 1 unit/s, and 1 unit/s², where the key is missing.
Result<Figure> rate(const IniFile& ini, const std::string& section, const char* key, double factor,
                    const Range& range) {
  auto given = figure(ini, section.c_str(), key, factor, range);
  if (!given) {
    return std::unexpected(given.error());
  }
  if (*given) {
    return **given;
  }
  return Figure{.value = factor,
                .from = fmt::format("[{}] {} is missing: LinuxCNC takes 1", section, key),
                .where = {},
                .clipped = {}};
}

/// One end of the travel; `sign` +1: the upper. The axis's and its joints', the tightest counts.
struct End {
  std::optional<IniNumber> tightest;
};

Result<End> end_of(const IniFile& ini, const ConfiguredAxis& axis, const char* key, double sign) {
  std::vector<std::string> sections{fmt::format("AXIS_{}", axis.letter)};
  for (const std::size_t joint : axis.joints) {
    sections.push_back(fmt::format("JOINT_{}", joint));
  }
  End out;
  for (const std::string& section : sections) {
    const auto number = ini.number(section, key);
    if (!number) {
      return std::unexpected(number.error());
    }
    if (*number && (!out.tightest || sign * (*number)->value < sign * out.tightest->value)) {
      out.tightest = **number;
    }
  }
  return out;
}

std::optional<Figure> bounded(const End& end, double factor, double no_limit) {
  if (!end.tightest || std::abs(end.tightest->value * factor) > no_limit) {
    return std::nullopt;
  }
  const IniEntry& entry = *end.tightest->entry;
  return Figure{.value = end.tightest->value * factor,
                .from = entry.text(),
                .where = fmt::format("{}:{}", entry.file, entry.line),
                .clipped = {}};
}

Result<std::string> slower_joint(const IniFile& ini, const ConfiguredAxis& axis,
                                 double speed_units_s, double factor) {
  for (const std::size_t joint : axis.joints) {
    const auto own = ini.number(fmt::format("JOINT_{}", joint), "MAX_VELOCITY");
    if (!own) {
      return std::unexpected(own.error());
    }
    if (*own && (*own)->value * factor < speed_units_s * (1.0 - 1e-9)) {
      return (*own)->entry->text();
    }
  }
  return std::string{};
}

}  // namespace

Result<std::optional<Figure>> figure(const IniFile& ini, const char* section, const char* key,
                                     double factor, const Range& range) {
  const auto number = ini.number(section, key);
  if (!number) {
    return std::unexpected(number.error());
  }
  if (!*number) {
    return std::nullopt;
  }
  const double value = (*number)->value * factor;
  const IniEntry& entry = *(*number)->entry;
  if (value < range.least) {
    return refuse(entry.file, entry.line,
                  fmt::format("{} is {:.6g} {}; allowed: {:.6g} … {:.6g}", entry.text(), value,
                              range.unit, range.least, range.most),
                  fmt::format("correct {}", key));
  }
  Figure out{.value = std::min(value, range.most),
             .from = entry.text(),
             .where = fmt::format("{}:{}", entry.file, entry.line),
             .clipped = {}};
  if (value > range.most) {
    out.clipped = fmt::format("{}: {} is {:.6g} {}: {:.6g} is taken, the largest allowed",
                              out.where, out.from, value, range.unit, range.most);
  }
  return out;
}

Result<AxisLimits> limits_of(const IniFile& ini, const Configuration& machine,
                             const ConfiguredAxis& axis) {
  const double factor = factor_of(machine, axis);
  const std::string section = fmt::format("AXIS_{}", axis.letter);
  const auto speed =
      rate(ini, section, "MAX_VELOCITY", factor, axis.rotary ? kSpeed_deg_s : kSpeed_mm_s);
  const auto acceleration = speed ? rate(ini, section, "MAX_ACCELERATION", factor,
                                         axis.rotary ? kAcceleration_deg_s2 : kAcceleration_mm_s2)
                                  : std::unexpected(speed.error());
  const auto lower =
      acceleration ? end_of(ini, axis, "MIN_LIMIT", -1.0) : std::unexpected(acceleration.error());
  const auto upper = lower ? end_of(ini, axis, "MAX_LIMIT", 1.0) : std::unexpected(lower.error());
  const auto slower =
      upper ? slower_joint(ini, axis, speed->value, factor) : std::unexpected(upper.error());
  if (!slower) {
    return std::unexpected(slower.error());
  }
  if (lower->tightest && upper->tightest && lower->tightest->value >= upper->tightest->value) {
    const IniEntry& max = *upper->tightest->entry;
    const IniEntry& min = *lower->tightest->entry;
    return refuse(
        max.file, max.line,
        fmt::format("{} is not above {} ({}:{})", max.text(), min.text(), min.file, min.line),
        fmt::format("give the axis {} room between MIN_LIMIT and MAX_LIMIT", axis.letter));
  }
  const double none = axis.rotary ? kNoLimit_deg : kNoLimit_mm;
  return AxisLimits{.speed_units_s = *speed,
                    .acceleration_units_s2 = *acceleration,
                    .min = bounded(*lower, factor, none),
                    .max = bounded(*upper, factor, none),
                    .slower_joint = *slower};
}

}  // namespace steadyrest::adapters::linuxcnc::config
