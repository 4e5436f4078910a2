// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/signal/path.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::string_view kLetters = "XYZABCUVW";

bool is_rotary(char letter) {
  return letter == 'A' || letter == 'B' || letter == 'C';
}

Result<const IniEntry*> needed(const IniFile& ini, const char* section, const char* key,
                               const char* to_do) {
  const IniEntry* const entry = ini.find(section, key);
  if (entry == nullptr || entry->value.empty()) {
    const std::size_t line = entry != nullptr ? entry->line : ini.section_line(section);
    return refuse(entry != nullptr ? entry->file : ini.path(), line,
                  fmt::format("there is no [{}] {}", section, key), to_do);
  }
  return entry;
}

struct NamedUnit {
  std::string_view name;
  double value;
};

/// LinuxCNC's own names; a number is the unit's inverse: units per mm, or per degree.
Result<double> unit(const IniFile& ini, const char* key, std::span<const NamedUnit> names,
                    const char* allowed) {
  const auto entry = needed(ini, "TRAJ", key, allowed);
  if (!entry) {
    return std::unexpected(entry.error());
  }
  for (const NamedUnit& named : names) {
    if ((*entry)->value == named.name) {
      return named.value;
    }
  }
  const auto number = ini.number("TRAJ", key);
  if (!number || (*number)->value <= 0.0) {
    return refuse((*entry)->file, (*entry)->line, fmt::format("{} is not a unit", (*entry)->text()),
                  allowed);
  }
  return 1.0 / (*number)->value;
}

Result<std::size_t> joints_of(const IniFile& ini) {
  const auto entry = needed(ini, "KINS", "JOINTS", "add JOINTS, the number of joints, to [KINS]");
  if (!entry) {
    return std::unexpected(entry.error());
  }
  const auto number = ini.number("KINS", "JOINTS");
  if (!number) {
    return std::unexpected(number.error());
  }
  const double joints = (*number)->value;
  if (joints < 1.0 || joints > 16.0 || joints != std::floor(joints)) {
    return refuse((*entry)->file, (*entry)->line,
                  fmt::format("{}; allowed: whole numbers 1 … 16", (*entry)->text()),
                  "write the number of joints");
  }
  return static_cast<std::size_t>(joints);
}

std::string upper(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

/// The letter of each joint: what `coordinates=` says, else X Y Z A B C U V W.
Result<std::string> letters_of_joints(const IniFile& ini) {
  const auto entry =
      needed(ini, "KINS", "KINEMATICS", "add KINEMATICS = trivkins coordinates=XYZ to [KINS]");
  if (!entry) {
    return std::unexpected(entry.error());
  }
  const auto words = words_of((*entry)->value);
  if (words.empty() || words.front() != "trivkins") {
    return refuse(
        (*entry)->file, (*entry)->line,
        fmt::format("{}: its joints are not its axes; allowed: trivkins", (*entry)->text()),
        "the layer needs a joint for each axis; it cannot work on this machine");
  }
  std::string letters(kLetters);
  for (const std::string& word : words) {
    if (upper(word).starts_with("COORDINATES=")) {
      letters = upper(word.substr(word.find('=') + 1));
    }
  }
  const std::size_t wrong = letters.find_first_not_of(kLetters);
  if (letters.empty() || wrong != std::string::npos) {
    return refuse((*entry)->file, (*entry)->line,
                  fmt::format("{}: allowed letters: X Y Z A B C U V W", (*entry)->text()),
                  "write one letter for each joint, without blanks");
  }
  return letters;
}

/// `X Y Z`, `XYZ`, or a gantry's `X Y Y Z`.
Result<std::string> coordinates_of(const IniFile& ini) {
  const auto entry =
      needed(ini, "TRAJ", "COORDINATES", "add COORDINATES, the letters of the axes, to [TRAJ]");
  if (!entry) {
    return std::unexpected(entry.error());
  }
  std::string out = upper((*entry)->value);
  std::erase_if(out, [](char c) { return c == ' ' || c == '\t'; });
  if (out.find_first_not_of(kLetters) != std::string::npos) {
    return refuse((*entry)->file, (*entry)->line,
                  fmt::format("{}: allowed letters: X Y Z A B C U V W", (*entry)->text()),
                  "write the letters of the axes");
  }
  return out;
}

/// [AXIS_L] and [JOINT_N] must be there, and the joint of the kind that the letter has.
Result<void> check_sections(const IniFile& ini, const ConfiguredAxis& axis) {
  const std::string section = fmt::format("AXIS_{}", axis.letter);
  if (!ini.has_section(section)) {
    return refuse(ini.path(), fmt::format("there is no section [{}]", section),
                  fmt::format("add [{}] with MIN_LIMIT, MAX_LIMIT, MAX_VELOCITY and "
                              "MAX_ACCELERATION, or take {} out of [TRAJ] COORDINATES",
                              section, axis.letter));
  }
  for (const std::size_t joint : axis.joints) {
    const std::string name = fmt::format("JOINT_{}", joint);
    if (!ini.has_section(name)) {
      return refuse(ini.path(), fmt::format("there is no section [{}]", name),
                    fmt::format("add [{}], the joint of the axis {}", name, axis.letter));
    }
    const IniEntry* const type = ini.find(name, "TYPE");
    if (type != nullptr && (upper(type->value) == "ANGULAR") != axis.rotary) {
      return refuse(type->file, type->line,
                    fmt::format("{} for the axis {}, which is {}", type->text(), axis.letter,
                                axis.rotary ? "rotary" : "linear"),
                    "X Y Z U V W are linear, A B C rotary: correct TYPE or the letter");
    }
  }
  return {};
}

/// The axes in the order of a machine file, with placeholders for a missing X, Y or Z.
Result<std::vector<ConfiguredAxis>> axes_of(const IniFile& ini) {
  const auto joints = joints_of(ini);
  const auto letters = joints ? letters_of_joints(ini) : std::unexpected(joints.error());
  const auto coordinates = letters ? coordinates_of(ini) : std::unexpected(letters.error());
  if (!coordinates) {
    return std::unexpected(coordinates.error());
  }
  const IniEntry& entry = *ini.find("TRAJ", "COORDINATES");
  std::vector<ConfiguredAxis> out;
  std::size_t present = 0;
  for (const char letter : kLetters) {
    ConfiguredAxis axis{.letter = letter, .rotary = is_rotary(letter), .joints = {}};
    const bool wanted = coordinates->find(letter) != std::string::npos;
    for (std::size_t i = 0; wanted && i < std::min(*joints, letters->size()); ++i) {
      if ((*letters)[i] == letter) {
        axis.joints.push_back(i);
      }
    }
    if (wanted && axis.joints.empty()) {
      return refuse(
          entry.file, entry.line,
          fmt::format("{}, but the {} joints of [KINS] have no {}", entry.text(), *joints, letter),
          "make [TRAJ] COORDINATES, [KINS] JOINTS and coordinates= agree");
    }
    if (auto checked = wanted ? check_sections(ini, axis) : Result<void>{}; !checked) {
      return std::unexpected(checked.error());
    }
    present += axis.present() ? 1 : 0;
    if (axis.present() || letter == 'X' || letter == 'Y' || letter == 'Z') {
      out.push_back(std::move(axis));
    }
  }
  if (present < 2) {
    return refuse(entry.file, entry.line,
                  fmt::format("{}: one axis; allowed: 2 or more", entry.text()),
                  "the layer cannot work on a machine with this number of axes");
  }
  if (out.size() > kernel::signal::kMaxAxes) {
    return refuse(entry.file, entry.line,
                  fmt::format("{}: {} axes, counting X, Y and Z; allowed: 2 … {}", entry.text(),
                              out.size(), kernel::signal::kMaxAxes),
                  "the layer cannot work on a machine with this number of axes");
  }
  return out;
}

Result<double> servo_period_ms(const IniFile& ini) {
  const auto entry = needed(ini, "EMCMOT", "SERVO_PERIOD",
                            "add SERVO_PERIOD, in nanoseconds, to [EMCMOT]: 1000000 is usual");
  if (!entry) {
    return std::unexpected(entry.error());
  }
  const auto number = ini.number("EMCMOT", "SERVO_PERIOD");
  if (!number) {
    return std::unexpected(number.error());
  }
  const double period_ms = (*number)->value * 1e-6;
  if (!(period_ms >= 0.05 && period_ms <= 100.0)) {
    return refuse((*entry)->file, (*entry)->line,
                  fmt::format("{}; allowed: 50000 … 100000000", (*entry)->text()),
                  "give the servo period in nanoseconds");
  }
  return period_ms;
}

}  // namespace

Result<Configuration> configuration_of(const IniFile& ini) {
  static constexpr std::array kLinear = {
      NamedUnit{"mm", 1.0},    NamedUnit{"metric", 1.0},    NamedUnit{"in", 25.4},
      NamedUnit{"inch", 25.4}, NamedUnit{"imperial", 25.4},
  };
  static constexpr std::array kAngular = {
      NamedUnit{"deg", 1.0},
      NamedUnit{"degree", 1.0},
      NamedUnit{"grad", 0.9},
      NamedUnit{"gon", 0.9},
      NamedUnit{"rad", 180.0 / std::numbers::pi},
  };
  auto axes = axes_of(ini);
  if (!axes) {
    return std::unexpected(axes.error());
  }
  const auto mm = unit(ini, "LINEAR_UNITS", kLinear,
                       "write LINEAR_UNITS = mm or LINEAR_UNITS = inch in [TRAJ]");
  if (!mm) {
    return std::unexpected(mm.error());
  }
  Result<double> deg = 1.0;
  if (std::ranges::any_of(*axes, &ConfiguredAxis::rotary)) {
    deg = unit(ini, "ANGULAR_UNITS", kAngular, "write ANGULAR_UNITS = degree in [TRAJ]");
  }
  const auto period = deg ? servo_period_ms(ini) : std::unexpected(deg.error());
  if (!period) {
    return std::unexpected(period.error());
  }
  const IniEntry* const machine = ini.find("EMC", "MACHINE");
  return Configuration{.name = machine != nullptr ? machine->value : "",
                       .mm_per_unit = *mm,
                       .deg_per_unit = *deg,
                       .servo_period_ms = *period,
                       .axes = std::move(*axes)};
}

}  // namespace steadyrest::adapters::linuxcnc::config
