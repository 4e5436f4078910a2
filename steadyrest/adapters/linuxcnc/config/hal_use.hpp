// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// A line of a HAL file, or of the INI file's HALCMD.
struct Where {
  std::string file;
  std::size_t line = 0;  ///< the first
  std::size_t last = 0;
  /// When LinuxCNC runs it, before the layer's HALFILE or after it.
  enum class Stage : std::uint8_t { before, after } stage = Stage::before;
  const IniEntry* halfile = nullptr;  ///< that leads there
  bool sourced = false;               ///< by a `source` line of another file

  [[nodiscard]] std::string text() const;  ///< `FILE:LINE`
};

/// A component that a configuration loads.
struct Loaded {
  Where where;
  std::optional<std::size_t> count;  ///< `count=`, and 1 for a line without names
  std::vector<std::string> names;    ///< `names=`
  std::vector<std::string> others;   ///< further arguments
};

/// A pin that is connected to a signal.
struct Linked {
  std::string signal;
  Where where;
};

/// A use of the spindle's commanded speed.
struct SpindleUse {
  std::string output;  ///< `speed-out`, `speed-out-rps` …
  Linked linked;
  std::vector<std::string> readers;  ///< other pins on that signal
};

/// What the HAL files of a configuration load and connect.
///
/// Refused: files in Tcl and TWOPASS, whose commands are only known when they run, and files that
/// cannot be read.
class HalUse {
 public:
  static kernel::outcome::Result<HalUse> of(const IniFile& ini);

  [[nodiscard]] const Loaded* loaded(const std::string& component) const;
  [[nodiscard]] const Linked* linked(const std::string& pin) const;
  /// The first `setp` of the pin.
  [[nodiscard]] const Where* set(const std::string& pin) const;
  /// A pin or parameter with its value; the last `setp` counts.
  struct Setting {
    std::string value;
    Where where;
  };
  [[nodiscard]] const Setting* setting(const std::string& pin) const;
  [[nodiscard]] std::vector<SpindleUse> spindle_uses() const;
  /// The first signal or component instance whose name begins so.
  [[nodiscard]] const Where* named(const std::string& prefix) const;
  /// Pins with the signals of the machine's own files.
  [[nodiscard]] std::map<std::string, std::string> signals() const;

 private:
  friend class HalReader;
  std::map<std::string, Loaded> loaded_;
  std::map<std::string, Linked> pins_;
  std::map<std::string, Where> set_;
  std::map<std::string, Setting> settings_;
  std::map<std::string, Where> names_;
};

/// Where LinuxCNC finds the file of a HALFILE entry, `LIB:` and its library included; empty:
/// nowhere.
[[nodiscard]] std::string hal_file_path(const IniFile& ini, const std::string& name);

}  // namespace steadyrest::adapters::linuxcnc::config
