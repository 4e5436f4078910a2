// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/limits.hpp>
#include <steadyrest/adapters/linuxcnc/config/program_section.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/machine/program.hpp>

// The keys that LinuxCNC 2.9's interpreter and task read. What is neither carried nor without
// effect on a program's path is named.
namespace steadyrest::adapters::linuxcnc::config {
namespace {

/// Length of a UTF-8 character at the beginning of `text`; 0: not UTF-8.
std::size_t utf8_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t size = first < 0x80                    ? 1
                           : first >= 0xC2 && first < 0xE0 ? 2
                           : first >= 0xE0 && first < 0xF0 ? 3
                           : first >= 0xF0 && first < 0xF5 ? 4
                                                           : 0;
  const bool whole =
      size != 0 && size <= text.size() &&
      std::ranges::all_of(text.substr(1, size - 1), [](char c) { return (c & 0xC0) == 0x80; });
  return whole ? size : 0;
}

struct Known {
  std::string_view section;
  std::string_view key;
  std::string_view why;  ///< empty: carried, or without effect on a path
};

constexpr std::array kKnown = {
    Known{"RS274NGC", "RS274NGC_STARTUP_CODE", ""},
    Known{"RS274NGC", "REMAP", ""},
    Known{"RS274NGC", "RETAIN_G43", ""},
    Known{"RS274NGC", "DISABLE_FANUC_STYLE_SUB", ""},
    Known{"RS274NGC", "DISABLE_G92_PERSISTENCE", ""},
    Known{"RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_MM", ""},
    Known{"RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_INCH", ""},
    Known{"RS274NGC", "SUBROUTINE_PATH", ""},
    Known{"RS274NGC", "LOG_LEVEL", ""},
    Known{"RS274NGC", "LOG_FILE", ""},
    Known{"RS274NGC", "PARAMETER_FILE",
          "offsets change with each set-up: name the file with --variables"},
    Known{"RS274NGC", "USER_M_PATH", "M100 … M199 run programs of the machine; they are refused"},
    Known{"RS274NGC", "USER_DEFINED_FUNCTION_MAX_DIRS",
          "M100 … M199 run programs of the machine; they are refused"},
    Known{"RS274NGC", "ORIENT_OFFSET", "the spindle's angle at M19 moves no axis"},
    Known{"RS274NGC", "ON_ABORT_COMMAND", "what runs after an abort is not planned"},
    Known{"RS274NGC", "FEATURES", "its bits are not read"},
    Known{"RS274NGC", "INI_VARS", "#<_ini[…]> is refused"},
    Known{"RS274NGC", "HAL_PIN_VARS", "#<_hal[…]> is refused"},
    Known{"RS274NGC", "OWORD_NARGS", "#<n_args> is refused"},
    Known{"RS274NGC", "OWORD_WARNONLY", "a faulty O-word is refused"},
    Known{"RS274NGC", "NO_DOWNCASE_OWORD", "names of subprograms are read in lower case"},
    Known{"EMCIO", "TOOL_CHANGE_QUILL_UP", ""},
    Known{"EMCIO", "TOOL_CHANGE_AT_G30", ""},
    Known{"EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", ""},
    Known{"EMCIO", "TOOL_CHANGE_POSITION", ""},
    Known{"EMCIO", "TOOL_TABLE", "tools change with each set-up: name the table with --tools"},
    Known{"EMCIO", "DB_PROGRAM", "tools from a database are not read: give a table with --tools"},
    Known{"EMCIO", "RANDOM_TOOLCHANGER", "pockets are not followed; T0 means no tool"},
    Known{"PYTHON", "TOPLEVEL", "subprograms and remaps in Python are not read; calls are refused"},
    Known{"EMC", "RS274NGC_STARTUP_CODE", ""},
};

class Section {
 public:
  Section(const IniFile& ini, const Configuration& machine) : ini_(ini), machine_(machine) {}

  ProgramSection make(const std::string& hal_unread) {
    out_.text = "\n[program]\n";
    startup();
    remaps();
    rotary("WRAPPED_ROTARY", "wrapped_axes", false);
    rotary("LOCKING_INDEXER_JOINT", "indexer_axes", true);
    flag("EMCIO", "TOOL_CHANGE_QUILL_UP", "tool_change_quill_up", true);
    flag("EMCIO", "TOOL_CHANGE_AT_G30", "tool_change_at_g30", true);
    flag("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", "tool_change_with_spindle_on", true);
    position();
    flag("RS274NGC", "RETAIN_G43", "tool_change_keeps_offset", true);
    flag("RS274NGC", "DISABLE_FANUC_STYLE_SUB", "fanuc_subprograms", false);
    flag("RS274NGC", "DISABLE_G92_PERSISTENCE", "g92_persists", false);
    tolerance("CENTER_ARC_RADIUS_TOLERANCE_MM", "arc_tolerance_mm", 1.0, 0.001);
    tolerance("CENTER_ARC_RADIUS_TOLERANCE_INCH", "inch_arc_tolerance_mm", 25.4, 0.00004);
    folders();
    others();
    if (!hal_unread.empty()) {
      out_.not_carried.push_back("the HAL files are not read: " + hal_unread);
    }
    for (const std::string& lost : out_.not_carried) {
      out_.text += "# not carried: " + comment_of(lost) + "\n";
    }
    return std::move(out_);
  }

 private:
  static std::string from(const IniEntry& entry) {
    return fmt::format("{}:{}: {}", entry.file, entry.line, entry.text());
  }
  void carried(const char* key, std::string value, const IniEntry& entry) {
    out_.text +=
        fmt::format("{:<31} # {}\n", fmt::format("{} = {}", key, value), comment_of(entry.text()));
    out_.values.push_back(
        {.key = std::string("program.") + key, .value = std::move(value), .from = from(entry)});
  }
  void lost(const IniEntry& entry, std::string_view why) {
    out_.not_carried.push_back(fmt::format("{}: {}", from(entry), why));
  }

  // LinuxCNC's task looks in [EMC] first.
  void startup() {
    const IniEntry* entry = ini_.find("EMC", "RS274NGC_STARTUP_CODE");
    entry = entry != nullptr ? entry : ini_.find("RS274NGC", "RS274NGC_STARTUP_CODE");
    if (entry == nullptr || entry->value.empty()) {
      return;
    }
    constexpr std::size_t kMost = 255;
    if (entry->value.size() > kMost) {
      lost(*entry, "longer than a block of the control");
      return;
    }
    carried("startup", toml_string(entry->value, kMost), *entry);
  }

  void remaps() {
    std::string codes;
    const IniEntry* first = nullptr;
    for (const IniEntry* entry : ini_.all("RS274NGC", "REMAP")) {
      const auto words = words_of(entry->value);
      std::string code = words.empty() ? std::string{} : words.front();
      std::ranges::transform(code, code.begin(),
                             [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      if (!kernel::machine::remapped_code(code)) {
        lost(*entry, "is not a code that can be remapped");
        continue;
      }
      codes += (codes.empty() ? "" : " ") + code;
      first = first == nullptr ? entry : first;
    }
    if (first != nullptr) {
      carried("remapped", '"' + codes + '"', *first);
    }
  }

  /// Whole number as LinuxCNC reads it; nothing without one.
  static std::optional<long> whole(const IniEntry* entry) {
    if (entry == nullptr) {
      return std::nullopt;
    }
    char* end = nullptr;
    const long value = std::strtol(entry->value.c_str(), &end, 0);
    return end == entry->value.c_str() ? std::nullopt : std::optional(value);
  }

  void flag(const char* section, const char* ini_key, const char* key, bool value) {
    const IniEntry* const entry = ini_.find(section, ini_key);
    if (whole(entry).value_or(0) != 0) {
      carried(key, value ? "true" : "false", *entry);
    }
  }

  void rotary(const char* ini_key, const char* key, bool zero_counts) {
    std::string letters;
    const IniEntry* first = nullptr;
    for (const char letter : {'A', 'B', 'C'}) {
      const IniEntry* const entry = ini_.find(fmt::format("AXIS_{}", letter), ini_key);
      const auto value = whole(entry);
      if (value && (zero_counts ? *value >= 0 : *value != 0)) {
        letters += letter;
        first = first == nullptr ? entry : first;
      }
    }
    if (first != nullptr) {
      carried(key, '"' + letters + '"', *first);
    }
  }

  // Three, six or nine numbers, of which a machine file takes X Y Z A B C.
  void position() {
    const IniEntry* const entry = ini_.find("EMCIO", "TOOL_CHANGE_POSITION");
    if (entry == nullptr) {
      return;
    }
    std::istringstream in(entry->value);
    std::vector<double> values;
    for (double value = 0.0; in >> value;) {
      values.push_back(value);
    }
    if (values.size() < 3) {
      lost(*entry, "fewer than three numbers; LinuxCNC ignores it");
      return;
    }
    const auto three = [&](std::size_t at, double factor) {
      return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", values[at] * factor,
                         values[at + 1] * factor, values[at + 2] * factor);
    };
    carried("tool_change_position_mm", three(0, machine_.mm_per_unit), *entry);
    if (values.size() >= 6) {
      carried("tool_change_rotary_deg", three(3, machine_.deg_per_unit), *entry);
    }
    if (values.size() >= 9) {
      lost(*entry, "U, V and W of the position");
    }
  }

  /// LinuxCNC takes from its least to its own 2 √2 thou, as rs274 shows.
  void tolerance(const char* ini_key, const char* key, double unit_mm, double least) {
    constexpr double kOwn_mm = 0.0282842712474619;
    const auto value = ini_.number("RS274NGC", ini_key);
    if (!value || !*value) {
      return;
    }
    const double mm = (*value)->value * unit_mm;
    if (mm >= least * unit_mm && mm <= kOwn_mm * (unit_mm == 1.0 ? 1.0 : 2.54)) {
      carried(key, fmt::format("{:.10g}", mm), *(*value)->entry);
    } else {
      lost(*(*value)->entry, "out of range; LinuxCNC takes its own");
    }
  }

  // The interpreter searches the folder of the programs first, then the others in order.
  void folders() {
    namespace fs = std::filesystem;
    std::string all;
    const IniEntry* first = nullptr;
    for (const IniEntry* entry :
         {ini_.find("DISPLAY", "PROGRAM_PREFIX"), ini_.find("RS274NGC", "SUBROUTINE_PATH")}) {
      std::istringstream in(entry == nullptr ? std::string{} : entry->value);
      for (std::string name; std::getline(in, name, ':');) {
        const char* const home = std::getenv("HOME");
        name = std::string(trimmed(name));
        if (name.starts_with("~/") && home != nullptr) {
          name = home + name.substr(1);
        }
        if (name.empty()) {
          continue;
        }
        const fs::path path = fs::absolute(fs::path(ini_.path()).parent_path() / name);
        all += (all.empty() ? "" : ":") + path.lexically_normal().string();
        first = first == nullptr ? entry : first;
      }
    }
    if (first == nullptr) {
      return;
    }
    constexpr std::size_t kMost = 4000;
    if (all.size() > kMost) {
      lost(*first, "too long for a machine file: name the folders with --subprograms");
      return;
    }
    carried("subprogram_folders", toml_string(all, kMost), *first);
  }

  void others() {
    for (const IniEntry& entry : ini_.entries()) {
      const auto known = std::ranges::find_if(kKnown, [&](const Known& one) {
        return one.section == entry.section && one.key == entry.key;
      });
      if (known != kKnown.end() && !known->why.empty()) {
        lost(entry, known->why);
      } else if (known == kKnown.end() && entry.section == "RS274NGC") {
        lost(entry, "not known to be of LinuxCNC 2.9's interpreter");
      } else if (entry.key == "LOCKING_INDEXER" && entry.section.starts_with("AXIS_")) {
        lost(entry, "LinuxCNC 2.9 takes LOCKING_INDEXER_JOINT");
      }
    }
  }

  const IniFile& ini_;
  const Configuration& machine_;
  ProgramSection out_;
};

}  // namespace

std::string toml_string(std::string_view text, std::size_t most) {
  std::string out;
  for (std::size_t i = 0; !text.empty() && i < most; ++i) {
    const std::size_t size = utf8_length(text);
    const bool control = size == 1 && (text.front() < ' ' || text.front() == '\x7f');
    if (text.front() == '"' || text.front() == '\\') {
      out += '\\';
    }
    // E0 and F0 have over-long forms and surrogates behind them, which TOML refuses.
    const bool odd = size > 2 && static_cast<unsigned char>(text[0]) % 16 == 0 &&
                     static_cast<unsigned char>(text[1]) < 0xA0;
    const bool surrogate =
        text.starts_with('\xED') && size == 3 && static_cast<unsigned char>(text[1]) >= 0xA0;
    out += size == 0 || control || odd || surrogate ? std::string_view("?") : text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return '"' + out + '"';
}

std::string comment_of(std::string_view text) {
  std::string out(text);
  std::ranges::replace_if(out, [](char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

ProgramSection program_section(const IniFile& ini, const Configuration& machine,
                               const std::string& hal_unread) {
  return Section(ini, machine).make(hal_unread);
}

kernel::outcome::Result<ProgramSection> planner_laws(const IniFile& ini, double mm_per_unit) {
  constexpr double kLeastJerk = 1.0;  // in the machine's units
  const auto type = figure(ini, "TRAJ", "PLANNER_TYPE", 1.0, {0.0, 2.0, ""});
  const auto jerk = figure(ini, "TRAJ", "MAX_LINEAR_JERK", mm_per_unit, {0.0, 1e9, "mm/s³"});
  if (!type || !jerk) {
    return std::unexpected(type ? jerk.error() : type.error());
  }
  ProgramSection out;
  out.text =
      "corner_tolerance_mm = 10\njunction_deviation_mm = 0\ncentripetal_share = 0.866\n"
      "blend_share = 0.5\nmin_block_cycles = 1.02\nmerge_share = 1\ncorner_acceleration_share = "
      "0.5\n"
      "stop_between_rapid_and_feed = true\nclips_programmed_feed = true\n";
  if (!*type || (*type)->value < 1.0) {
    return out;
  }
  const double limit_mm_s3 = *jerk ? (*jerk)->value : 1e9;
  if (limit_mm_s3 < kLeastJerk * mm_per_unit) {
    out.text += "# [TRAJ] MAX_LINEAR_JERK below 1: LinuxCNC takes its planner of 2.9.\n";
    return out;
  }
  const auto given = [&](const std::string& key, const std::string& value, const Figure& figure) {
    out.text += fmt::format("{} = {}  # {}\n", key, value, comment_of(figure.from));
    out.values.push_back({.key = "control." + key,
                          .value = value,
                          .from = fmt::format("{}: {}", figure.where, figure.from)});
  };
  given("planner", "\"s_curve\"", **type);
  if (*jerk) {
    given("max_path_jerk_mm_s3", fmt::format("{:.10g}", limit_mm_s3), **jerk);
  }
  return out;
}

}  // namespace steadyrest::adapters::linuxcnc::config
