// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <map>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/configuration.hpp>
#include <steadyrest/adapters/linuxcnc/config/hal_use.hpp>
#include <steadyrest/adapters/linuxcnc/config/ini_file.hpp>
#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/marked_lines.hpp>
#include <steadyrest/adapters/linuxcnc/config/setup.hpp>
#include <steadyrest/adapters/linuxcnc/config/setup_notes.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// LinuxCNC loads a component once only. Where a file of the machine loads one that the layer needs,
// its line gets the layer's instances; a file of LinuxCNC's library is copied for that.
namespace steadyrest::adapters::linuxcnc::config {
namespace {

namespace fs = std::filesystem;
using kernel::outcome::refuse;
using kernel::outcome::Result;

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) {
    out += (out.empty() ? "" : ",") + name;
  }
  return out;
}

std::unexpected<kernel::outcome::Refusal> shared(const std::string& file, std::size_t line) {
  return refuse(file, line, "is set up for another INI file that loads it too",
                "make a copy of the file without the layer's blocks and name the copy in this INI "
                "file");
}

class Planner {
 public:
  Planner(const std::string& path, const std::string& text, const SetupOptions& options,
          const IniFile& ini, const Configuration& machine, const HalUse& use)
      : path_(path), text_(text), options_(options), ini_(ini), machine_(machine), use_(use) {}

  Result<SetupPlan> plan() {
    describe();
    for (const auto step : {&Planner::nothing_taken, &Planner::share_components,
                            &Planner::layer_file, &Planner::ini_lines}) {
      if (auto done = (this->*step)(); !done) {
        return std::unexpected(done.error());
      }
    }
    std::ranges::sort(ini_edits_, {}, &Edit::first);
    plan_.files.insert(plan_.files.begin(),
                       {path_, text_, with_blocks(text_, ini_edits_, ini_name(path_))});
    for (const FileChange& change : plan_.files) {
      if (auto may = writable(change.file); !may) {
        return std::unexpected(may.error());
      }
    }
    add_notes(ini_, machine_, use_, layer_, options_, plan_.notes);
    return std::move(plan_);
  }

 private:
  void describe() {
    for (const ConfiguredAxis& axis : machine_.axes) {
      layer_.axes.push_back(
          {.letter = axis.letter,
           .joint = axis.present() ? std::optional(axis.joints.front()) : std::nullopt,
           .rotary = axis.rotary});
    }
    layer_.offset_components = options_.offsets;
    // Finer than any machine resolves: 0.01 µm, or half a millionth of an inch.
    layer_.offset_count = machine_.mm_per_unit > 10.0 ? 5e-7 : 1e-5;
    layer_.mm_per_unit = machine_.mm_per_unit;
    layer_.path_ramp_units_s = 5.0 / machine_.mm_per_unit;
    layer_.signal = use_.signals();
    for (const SpindleUse& use : use_.spindle_uses()) {
      if (use.output != "speed-out-rps") {
        layer_.drives.push_back(use.output);
      }
    }
  }

  /// The layer must be the only one that drives its pins, and the first of its names.
  Result<void> nothing_taken() {
    for (const char* prefix : {"layer-", "layer."}) {
      if (const Where* where = use_.named(prefix)) {
        if (const auto text = read_text(where->file); text && first_block(*text) != 0) {
          return shared(where->file, first_block(*text));
        }
        return refuse(where->file, where->line,
                      fmt::format("a name that begins with {} is there already", prefix),
                      "remove the layer's hand-written lines, or rename yours");
      }
    }
    for (const char* component : {"watchdog", "sampler"}) {
      if (const Loaded* loaded = use_.loaded(component)) {
        return refuse(loaded->where.file, loaded->where.line,
                      fmt::format("loads {}, which the layer needs for itself", component),
                      "remove that line and what belongs to it");
      }
    }
    for (const std::string& pin : driven_pins(layer_, options_.offsets)) {
      const Linked* const linked = use_.linked(pin);
      const bool offset = pin.starts_with("axis.");
      const Where* const set = offset ? use_.set(pin) : nullptr;
      const Where* const where = linked != nullptr ? &linked->where : set;
      if (where != nullptr) {
        return refuse(where->file, where->line,
                      fmt::format("the machine's own file drives {}", pin),
                      offset ? "leave --offsets out: this machine uses the offsets itself"
                             : "remove that connection: the layer needs the pin for itself");
      }
    }
    return {};
  }

  Result<void> share_components() {
    for (const Needed& one : needed(layer_)) {
      const Loaded* const loaded = one.names.empty() ? nullptr : use_.loaded(one.component);
      if (loaded == nullptr) {
        continue;
      }
      const Where& where = loaded->where;
      if (where.stage == Where::Stage::after) {
        return refuse(where.file, where.line,
                      fmt::format("loads {} after the layer's HAL file needs it", one.component),
                      "move that line to a HALFILE");
      }
      if (!loaded->others.empty()) {
        return refuse(where.file, where.line,
                      fmt::format("loads {} with {}, which setup cannot extend", one.component,
                                  loaded->others.front()),
                      "write names= or count= alone there");
      }
      layer_.loaded.insert(one.component);
      edits_[where.file].push_back({.first = where.line,
                                    .removed = where.last - where.line + 1,
                                    .added = {extended(one, *loaded)}});
      halfile_[where.file] = &where;
    }
    for (auto& [file, edits] : edits_) {
      std::ranges::sort(edits, {}, &Edit::first);
      if (auto done = change_hal_file(file, edits); !done) {
        return done;
      }
    }
    return {};
  }

  /// The machine's line with the layer's instances behind its own.
  std::string extended(const Needed& one, const Loaded& loaded) {
    if (!loaded.names.empty()) {
      return fmt::format("loadrt {} names={},{}", one.component, joined(loaded.names),
                         joined(one.names));
    }
    // Counted instances have numbers for names.
    std::size_t number = loaded.count.value_or(1);
    for (const std::string& name : one.names) {
      layer_.instance[name] = fmt::format("{}.{}", one.component, number++);
    }
    return fmt::format("loadrt {} count={}", one.component, number);
  }

  Result<void> change_hal_file(const std::string& file, const std::vector<Edit>& edits) {
    const auto text = read_text(file);
    if (!text) {
      return std::unexpected(text.error());
    }
    if (const std::size_t line = first_block(*text); line != 0) {
      return shared(file, line);
    }
    const Where& where = *halfile_[file];
    if (where.sourced) {
      return refuse(file, where.line,
                    "is loaded by `source`, and a line in it would have to change",
                    "name the file as HALFILE in the INI file");
    }
    const std::string changed = with_blocks(*text, edits, ini_name(path_));
    if (writable(file)) {
      plan_.files.push_back({file, *text, changed});
      return {};
    }
    return copy_of_library_file(file, changed, *where.halfile);
  }

  Result<void> copy_of_library_file(const std::string& file, const std::string& changed,
                                    const IniEntry& entry) {
    if (entry.included) {
      return refuse(entry.file, entry.line,
                    fmt::format("{} is a file of LinuxCNC's, of which a copy is needed, but this "
                                "line is in an included file",
                                entry.text()),
                    "move the line to the [HAL] section of the INI file");
    }
    const std::string name =
        fs::path(layer_file_name(path_)).stem().string() + "-" + fs::path(file).filename().string();
    if (auto done = create(name, own_file(changed, ini_name(path_))); !done) {
      return done;
    }
    ini_edits_.push_back({.first = entry.line,
                          .removed = entry.top_line - entry.line + 1,
                          .added = {"HALFILE = " + name}});
    return {};
  }

  /// A new file beside the INI file; one that an earlier setup left is replaced.
  Result<void> create(const std::string& name, const std::string& text) {
    const std::string path = beside(path_, name);
    std::error_code error;
    std::optional<std::string> before;
    if (fs::exists(path, error)) {
      const auto old = read_text(path);
      if (!old || is_own_file(*old) != Own::yes) {
        return refuse(path, "exists and is not as setup wrote it", "rename or delete it");
      }
      before = *old;
    }
    plan_.files.push_back({path, std::move(before), text});
    return {};
  }

  Result<void> layer_file() {
    std::string text = fmt::format(
        "# The layer's side of LinuxCNC for {}: axes, signals and components as its own files have "
        "them.\n",
        ini_name(path_));
    text += layer_text(layer_);
    if (options_.offsets) {
      text += "\n# Axis offsets.\n" + offsets_text(layer_);
    }
    return create(layer_file_name(path_), own_file(text, ini_name(path_)));
  }

  Result<void> ini_lines() {
    const auto files = ini_.all("HAL", "HALFILE");
    if (files.empty()) {
      return refuse(path_, ini_.section_line("HAL"), "there is no [HAL] HALFILE",
                    "give the INI file of a machine that runs");
    }
    const IniEntry& last = *files.back();
    if (!ini_.in_section_after(last.top_line, "HAL")) {
      return refuse(last.file, last.line,
                    fmt::format("the last HALFILE is in an included file in which [HAL] ends, too: "
                                "no line of {} can follow it",
                                ini_name(path_)),
                    "move this line to the INI file, or end the included file with [HAL]");
    }
    Edit edit{.first = last.top_line + 1, .removed = 0, .added = {}};
    if (ini_.find("HAL", "HALUI") == nullptr) {
      edit.added.emplace_back("HALUI = halui");
    }
    edit.added.push_back("HALFILE = " + layer_file_name(path_));
    ini_edits_.push_back(std::move(edit));
    for (const LayerAxis& axis : layer_.axes) {
      const bool moved = options_.offsets && axis.joint && !axis.rotary;
      if (auto done = moved ? offset_share(axis.letter) : Result<void>{}; !done) {
        return done;
      }
    }
    return {};
  }

  /// The share of speed and acceleration kept for offsets; the axis's own value stays.
  Result<void> offset_share(char letter) {
    const std::string section = fmt::format("AXIS_{}", letter);
    const auto own = ini_.number(section, "OFFSET_AV_RATIO");
    if (!own) {
      return std::unexpected(own.error());
    }
    if (*own && (*own)->value > 0.0) {
      return {};
    }
    if (*own) {
      return refuse((*own)->entry->file, (*own)->entry->line,
                    (*own)->entry->text() + " permits no offsets",
                    "give 0.01 … 0.9, or leave --offsets out");
    }
    const std::size_t line = ini_.section_line(section);
    if (!ini_.in_section_after(line, section)) {
      return refuse(
          path_, line,
          fmt::format("[{}] is in an included file with other sections behind it", section),
          fmt::format("put OFFSET_AV_RATIO = {:g} into [{}] there", options_.offset_share,
                      section));
    }
    ini_edits_.push_back({.first = line + 1,
                          .removed = 0,
                          .added = {fmt::format("OFFSET_AV_RATIO = {:g}", options_.offset_share)}});
    return {};
  }

  const std::string& path_;
  const std::string& text_;
  const SetupOptions& options_;
  const IniFile& ini_;
  const Configuration& machine_;
  const HalUse& use_;
  LayerHal layer_;
  SetupPlan plan_;
  std::vector<Edit> ini_edits_;
  std::map<std::string, std::vector<Edit>> edits_;  ///< of the machine's HAL files
  std::map<std::string, const Where*> halfile_;
};

}  // namespace

Result<SetupPlan> plan_setup(const std::string& ini_path, const SetupOptions& options) {
  const auto text = read_text(ini_path);
  if (!text) {
    return std::unexpected(text.error());
  }
  if (const std::size_t line = first_block(*text); line != 0) {
    return refuse(ini_path, line, "is set up already",
                  "to do it again, first take it out with --undo");
  }
  const auto ini = IniFile::parse(*text, ini_path);
  if (!ini) {
    return std::unexpected(ini.error());
  }
  const auto machine = configuration_of(*ini);
  if (!machine) {
    return std::unexpected(machine.error());
  }
  const auto may = writable(ini_path);
  if (!may) {
    return std::unexpected(may.error());
  }
  const auto use = HalUse::of(*ini);
  if (!use) {
    return std::unexpected(use.error());
  }
  return Planner(ini_path, *text, options, *ini, *machine, *use).plan();
}

}  // namespace steadyrest::adapters::linuxcnc::config
