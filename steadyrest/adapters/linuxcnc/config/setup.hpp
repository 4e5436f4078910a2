// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::linuxcnc::config {

/// One file before and after.
struct FileChange {
  std::string file;
  std::optional<std::string> before;  ///< none: it is created
  std::optional<std::string> after;   ///< none: it is removed
};

/// What the user should know, with the line that it is about.
struct Note {
  std::string file;
  std::size_t line = 0;
  std::string what;
  std::string to_do;
};

struct SetupPlan {
  std::vector<FileChange> files;
  std::vector<Note> notes;
};

struct SetupOptions {
  bool offsets = false;       ///< connect the axis offsets, too
  double offset_share = 0.2;  ///< OFFSET_AV_RATIO where an axis has none, 0.01 … 0.9
};

/// The layer's HAL file for the configuration, and the lines that bring it in. Refused: what the
/// readers of INI and HAL files refuse, files of the package, a configuration that is set up
/// already, and one in which the layer's pins or components are taken.
[[nodiscard]] kernel::outcome::Result<SetupPlan> plan_setup(const std::string& ini_path,
                                                            const SetupOptions& options);

/// All of it out again, byte for byte; other edits since then stay. Refused: a block or a file that
/// was edited since.
[[nodiscard]] kernel::outcome::Result<SetupPlan> plan_undo(const std::string& ini_path);

/// Writes all files or none, then removes. Refused: what cannot be written.
[[nodiscard]] kernel::outcome::Result<void> carry_out(const SetupPlan& plan);

/// The file beside the INI file: `mill.ini` → `mill-layer.hal`.
[[nodiscard]] std::string layer_file_name(const std::string& ini_path);

/// The name of the INI file in blocks and headers.
[[nodiscard]] std::string ini_name(const std::string& ini_path);

/// The path of a file beside the INI file.
[[nodiscard]] std::string beside(const std::string& ini_path, const std::string& name);

/// Refused: a file of the package, or one that may not be written.
[[nodiscard]] kernel::outcome::Result<void> writable(const std::string& path);

}  // namespace steadyrest::adapters::linuxcnc::config
