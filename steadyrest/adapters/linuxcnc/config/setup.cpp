// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/marked_lines.hpp>
#include <steadyrest/adapters/linuxcnc/config/setup.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/file/output_file.hpp>
#include <steadyrest/kernel/file/place.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// Undo, what it shares with setup, and the layer's files as they are shipped.
namespace steadyrest::adapters::linuxcnc::config {

namespace fs = std::filesystem;
using kernel::outcome::refuse;
using kernel::outcome::Result;

namespace {

/// `HALFILE = x` → `x`.
std::string halfile_of(std::string_view line) {
  const std::size_t equals = line.find('=');
  return equals != std::string_view::npos && trimmed(line.substr(0, equals)) == "HALFILE"
             ? std::string(trimmed(line.substr(equals + 1)))
             : std::string{};
}

/// Another configuration of the folder that loads this HAL file: a copy of the INI file, say.
std::string other_user(const std::string& ini_path, const std::string& name) {
  std::error_code error;
  const fs::path self = fs::weakly_canonical(ini_path, error);
  for (const auto& entry : fs::directory_iterator(beside(ini_path, ""), error)) {
    if (entry.path().extension() != ".ini" || fs::weakly_canonical(entry.path(), error) == self) {
      continue;
    }
    if (const auto other = IniFile::read(entry.path().string())) {
      const auto files = other->all("HAL", "HALFILE");
      if (std::ranges::any_of(files, [&](const IniEntry* one) { return one->value == name; })) {
        return entry.path().string();
      }
    }
  }
  return {};
}

/// A HAL file that setup wrote goes, unless it was edited or is used elsewhere.
Result<void> remove_own(const std::string& ini_path, const std::string& name, SetupPlan& plan) {
  const std::string path = beside(ini_path, name);
  std::error_code error;
  if (!fs::exists(path, error)) {
    plan.notes.push_back({path, 0, "is gone already", "nothing"});
    return {};
  }
  const auto text = read_text(path);
  if (!text) {
    return std::unexpected(text.error());
  }
  if (is_own_file(*text) != Own::yes) {
    return refuse(path, std::size_t{1}, "was edited since setup, so undo would lose something",
                  "keep your lines in a HAL file of another name, delete this one, and undo again");
  }
  if (const std::string other = other_user(ini_path, name); !other.empty()) {
    plan.notes.push_back({path, 0, "stays: " + other + " loads it, too",
                          "delete it when that configuration no longer needs it"});
    return {};
  }
  plan.files.push_back({path, *text, std::nullopt});
  return {};
}

/// Blocks in the machine's own HAL files. They end where the INI file's HALFILEs end: setup changes
/// no file that is sourced.
Result<void> undo_hal_files(const std::string& ini_path, const IniFile& ini, SetupPlan& plan) {
  for (const IniEntry* entry : ini.all("HAL", "HALFILE")) {
    const auto words = words_of(entry->value);
    const std::string path = words.empty() ? "" : hal_file_path(ini, words.front());
    const auto text = path.empty() ? Result<std::string>("") : read_text(path);
    const bool seen = std::ranges::any_of(
        plan.files, [&path](const FileChange& change) { return change.file == path; });
    if (!text || seen || first_block(*text) == 0) {
      continue;
    }
    auto out = without_blocks(*text, path, ini_name(ini_path));
    if (!out) {
      return std::unexpected(out.error());
    }
    if (out->blocks > 0) {
      plan.files.push_back({path, *text, out->text});
    }
  }
  return {};
}

LayerHal three_axes() {
  LayerHal layer;
  layer.axes = {{'X', 0, false}, {'Y', 1, false}, {'Z', 2, false}};
  return layer;
}

}  // namespace

std::string ini_name(const std::string& ini_path) {
  return fs::path(ini_path).filename().string();
}

std::string layer_file_name(const std::string& ini_path) {
  std::string stem = fs::path(ini_path).stem().string();
  std::ranges::replace_if(stem, [](char c) { return c == ' ' || c == '\t'; }, '_');
  return stem + "-layer.hal";
}

std::string beside(const std::string& ini_path, const std::string& name) {
  const fs::path folder = fs::path(ini_path).parent_path();
  return (folder.empty() && name.empty() ? fs::path(".") : folder / name).string();
}

Result<void> writable(const std::string& path) {
  std::error_code error;
  const std::string real = fs::weakly_canonical(path, error).string();
  constexpr const char* kCopy =
      "copy the configuration's folder to your home first (LinuxCNC's selector does it), and set "
      "the copy up";
  if (real.starts_with("/usr/")) {
    return refuse(path, "belongs to an installed package", kCopy);
  }
  const auto place = kernel::file::place_of(path);
  if (!place) {
    return refuse(path, place.error().what, kCopy);
  }
  return {};
}

Result<SetupPlan> plan_undo(const std::string& ini_path) {
  const auto text = read_text(ini_path);
  if (!text) {
    return std::unexpected(text.error());
  }
  const auto before = without_blocks(*text, ini_path, ini_name(ini_path));
  if (!before) {
    return std::unexpected(before.error());
  }
  if (before->blocks == 0) {
    return refuse(ini_path, "is not set up: it has no block of `steadyrest linuxcnc setup`",
                  "give the INI file that was set up, under its name then");
  }
  const auto ini = IniFile::parse(before->text, ini_path);
  if (!ini) {
    return std::unexpected(ini.error());
  }
  SetupPlan plan;
  plan.files.push_back({ini_path, *text, before->text});
  if (auto done = undo_hal_files(ini_path, *ini, plan); !done) {
    return std::unexpected(done.error());
  }
  for (const std::string& line : before->added) {
    const std::string name = halfile_of(line);
    for (const IniEntry* entry : ini->all("HAL", "HALFILE")) {
      if (!name.empty() && entry->value == name) {
        return refuse(entry->file, entry->line,
                      entry->text() + " is outside the block that setup wrote",
                      "delete this line, and undo again");
      }
    }
    if (auto done = name.empty() ? Result<void>{} : remove_own(ini_path, name, plan); !done) {
      return std::unexpected(done.error());
    }
  }
  for (const FileChange& change : plan.files) {
    if (auto may = writable(change.file); !may) {
      return std::unexpected(may.error());
    }
  }
  return plan;
}

Result<void> carry_out(const SetupPlan& plan) {
  std::vector<kernel::file::FileText> texts;
  for (const FileChange& change : plan.files) {
    if (change.after) {
      texts.push_back({change.file, *change.after});
    }
  }
  if (auto written = kernel::file::write_files(texts); !written) {
    return written;
  }
  // Nothing names them any more.
  for (const FileChange& change : plan.files) {
    std::error_code error;
    if (!change.after && !fs::remove(change.file, error) && error) {
      return refuse(change.file, "cannot be removed: " + error.message(), "remove it by hand");
    }
  }
  return {};
}

// What lies beside this folder as layer.hal and layer_offsets.hal.
std::string shipped_layer_hal() {
  return "# SPDX-License-Identifier: Apache-2.0\n"
         "# Made from config/layer_text.cpp; `cmake --build --preset release --target layer_hal` "
         "writes it. For three axes and one\n"
         "# spindle: a further HALFILE after the machine's own. `steadyrest linuxcnc setup` makes "
         "one for any other machine.\n"
         "# The machine's own files must leave motion.adaptive-feed free and load none of these "
         "components.\n" +
         layer_text(three_axes());
}

std::string shipped_offsets_hal() {
  return "# SPDX-License-Identifier: Apache-2.0\n"
         "# Made from config/layer_text.cpp, as layer.hal. Axis offsets of three linear axes: a "
         "HALFILE after layer.hal, where the\n"
         "# machine does not use axis.L.eoffset itself. Each [AXIS_L] section of the INI file "
         "needs OFFSET_AV_RATIO: the share of its\n"
         "# speed and acceleration kept for offsets.\n" +
         offsets_text(three_axes());
}

}  // namespace steadyrest::adapters::linuxcnc::config
