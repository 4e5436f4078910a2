// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/chatter/offline/process/process_file.hpp>
#include <steadyrest/chatter/offline/process/process_keys.hpp>
#include <steadyrest/chatter/offline/response/frf.hpp>
#include <steadyrest/chatter/offline/response/mode_fit.hpp>
#include <steadyrest/kernel/units/constants.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// The keys of each section are in process_keys.cpp with their ranges. Checked here is what a table
// of keys cannot express: which keys belong to milling or turning, which exclude one another, which
// need a third. Faults are collected, so that one run shows them all.
namespace steadyrest::chatter::offline {
namespace {

using kernel::outcome::Refusal;
using kernel::outcome::Result;
using kernel::units::kTurn;
using passport::Faults;
using passport::Given;
using passport::Key;
using passport::line_of;
using passport::SectionReader;

/// People write 51.429 for 360/7; the remainder is distributed.
constexpr double kPitchSumDeg = 0.01;
constexpr std::size_t kMostModes = 64;

/// Relative to the process file's folder.
std::filesystem::path response_path(const std::string& process, const std::string& response) {
  return std::filesystem::path(process).parent_path() / response;
}

/// Reads the whole tree. Each section is read even when another is faulty, so that one run shows
/// every fault.
class FileReader {
 public:
  explicit FileReader(Faults& faults) : faults_(faults) {}

  Process read(const toml::table& root) {
    SectionReader<Process>(faults_, process_keys(), "the top level")
        .read(root, process_, {"tool", "cut", "mode", "frf"});
    const Given cut = section<Cut>(root, "cut", cut_keys(), process_.cut);
    const bool milling = process_.cut.operation == Operation::milling;
    const Given tool = section<Tool>(root, "tool", tool_keys(), process_.tool, milling);
    if (milling) {
      check_milling(cut, tool);
    } else {
      check_turning(cut, tool);
    }
    check_diameter(cut, tool);
    if (root.get("mode") == nullptr && root.get("frf") == nullptr) {
      faults_.add(0, "there is no mode: nothing vibrates",
                  "add one [[mode]] for each mode of tool and workpiece, or a measured [[frf]]");
    }
    each(root, "mode", [this](const toml::table& table) { mode(table); });
    each(root, "frf", [this](const toml::table& table) { frf(table); });
    return process_;
  }

 private:
  /// The keys given in the section; empty when the section is absent.
  template <class S>
  Given section(const toml::table& root, std::string_view name, std::span<const Key<S>> keys,
                S& out, bool mandatory = true) {
    const std::string head = fmt::format("[{}]", name);
    const toml::node* node = root.get(name);
    if (node == nullptr) {
      if (mandatory) {
        faults_.add(0, fmt::format("there is no {}", head),
                    fmt::format("add {} with its keys", head));
      }
      return {};
    }
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      faults_.add(line_of(node->source()),
                  fmt::format("{} = {} is not a section", name, passport::shown(*node)),
                  fmt::format("write {} on a separate line, with its keys below", head));
      return {};
    }
    return SectionReader<S>(faults_, keys, head).read(*table, out);
  }

  void must_have(const Given& given, std::string_view key, std::string_view why) {
    if (given.line != 0 && !given.has(key)) {
      faults_.add(given.line, fmt::format("{} has no {}, which {}", given.section, key, why),
                  fmt::format("add {} = …", key));
    }
  }

  void has_none(const Given& given, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) {
      if (given.has(key)) {
        faults_.add(given.at({key}), fmt::format("{} of {} is for milling", key, given.section),
                    "remove it, or write operation = \"milling\"");
      }
    }
  }

  void check_milling(const Given& cut, const Given& tool) {
    must_have(tool, "teeth", "milling must have");
    must_have(cut, "radial_immersion", "milling must have");
    if (cut.has("radial_immersion") && process_.cut.radial_immersion < 1.0) {
      must_have(cut, "direction", "milling other than a slot must have");
    }
    check_length(tool, "pitch_deg", process_.tool.pitch_rad);
    check_length(tool, "runout_um", process_.tool.runout_mm);
    check_pitch(tool);
  }

  void check_length(const Given& tool, std::string_view key, const std::vector<double>& list) {
    if (!list.empty() && tool.has("teeth") && list.size() != process_.tool.teeth) {
      faults_.add(tool.at({key}),
                  fmt::format("{} has {} entries; the tool has {} teeth", key, list.size(),
                              process_.tool.teeth),
                  "give one entry per tooth");
    }
  }

  void check_pitch(const Given& tool) {
    std::vector<double>& pitch = process_.tool.pitch_rad;
    if (pitch.empty()) {
      return;
    }
    const double sum = std::accumulate(pitch.begin(), pitch.end(), 0.0);
    if (std::abs(sum - kTurn) * 360.0 / kTurn > kPitchSumDeg) {
      faults_.add(
          tool.at({"pitch_deg"}),
          fmt::format("the sum of pitch_deg is {:.6g}°; it must be 360°", sum * 360.0 / kTurn),
          "give the angle from each tooth to the one in front of it");
      return;
    }
    // Rounded degrees: spread what is missing, so that the teeth close the turn exactly.
    for (double& angle : pitch) {
      angle *= kTurn / sum;
    }
  }

  void check_turning(const Given& cut, const Given& tool) {
    has_none(cut, {"direction", "radial_immersion"});
    has_none(tool, {"helix_deg", "pitch_deg", "runout_um"});
    if (process_.tool.teeth > 1) {
      faults_.add(tool.at({"teeth"}), fmt::format("teeth = {} in turning", process_.tool.teeth),
                  "write teeth = 1 or leave it out");
    }
  }

  void check_diameter(const Given& cut, const Given& tool) {
    if (tool.has("diameter_mm")) {
      return;
    }
    if (process_.tool.helix_rad != 0.0) {
      faults_.add(tool.at({"helix_deg"}), "helix_deg without diameter_mm",
                  "add diameter_mm = … to [tool]");
    }
    if (process_.cut.process_damping_n_mm != 0.0) {
      faults_.add(cut.at({"process_damping_N_mm"}),
                  "process_damping_N_mm without diameter_mm, which sets the cutting speed",
                  "add diameter_mm = … to [tool]");
    }
  }

  /// The sections of a list, none if it is absent.
  template <class Read>
  void each(const toml::table& root, std::string_view name, Read read) {
    const toml::node* node = root.get(name);
    if (node == nullptr) {
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      faults_.add(line_of(node->source()), fmt::format("{} is not a list of sections", name),
                  fmt::format("write [[{}]] with double brackets, one per entry", name));
      return;
    }
    if (list->empty() || list->size() > kMostModes) {
      faults_.add(line_of(node->source()),
                  fmt::format("{} has {} entries; allowed: 1 … {}", name, list->size(), kMostModes),
                  "keep those that matter for the cut");
      return;
    }
    for (const toml::node& element : *list) {
      const toml::table* table = element.as_table();
      if (table == nullptr) {
        faults_.add(line_of(element.source()),
                    fmt::format("{} = {} is not a section", name, passport::shown(element)),
                    fmt::format("write [[{}]] on a separate line, with its keys below", name));
        return;
      }
      read(*table);
    }
  }

  /// The modes of a measured response.
  void frf(const toml::table& table) {
    FrfKeys keys;
    const std::size_t before = faults_.list.size();
    const Given given = SectionReader<FrfKeys>(faults_, frf_keys(), "[[frf]]").read(table, keys);
    // A measured file is read only if its section has no fault: the fit takes seconds.
    if (faults_.list.size() != before) {
      return;
    }
    const auto path = response_path(faults_.file, keys.file);
    // Otherwise its modes would count twice.
    if (!measured_.emplace(path.lexically_normal(), keys.axis).second) {
      faults_.add(given.at({"file"}), fmt::format("[[frf]] file = \"{}\" a second time", keys.file),
                  "name each response once for an axis");
      return;
    }
    const auto responses = read_frf(path.string());
    const auto fit = responses ? fit_modes(*responses, {}) : std::unexpected(responses.error());
    if (!fit) {
      Refusal why = fit.error();
      // The fault is reported at the process file's line; the place in the response goes into the
      // text.
      why.file = path.string();
      const std::string to_do = std::exchange(why.to_do, "");
      std::string what = kernel::outcome::text(why);
      what.erase(what.find_last_not_of("; ") + 1);
      faults_.add(given.at({"file"}), "[[frf]] " + what, to_do);
      return;
    }
    const bool x = keys.axis == ModeKeys::Axis::x;
    for (const FittedMode& fitted : fit->modes) {
      Mode mode;
      mode.shape = {x ? 1.0 : 0.0, x ? 0.0 : 1.0};
      mode.frequency_hz = fitted.frequency_hz;
      mode.damping_ratio = fitted.damping_ratio;
      mode.mass_kg = fitted.mass_kg;
      process_.modes.push_back(mode);
    }
  }

  void mode(const toml::table& table) {
    ModeKeys keys;
    const std::size_t before = faults_.list.size();
    const Given given = SectionReader<ModeKeys>(faults_, mode_keys(), "[[mode]]").read(table, keys);
    one_of(given, "axis", "angle_deg");
    one_of(given, "mass_kg", "stiffness_N_um");
    if (faults_.list.size() != before) {
      return;
    }
    Mode out;
    const double w = kTurn * keys.frequency_hz;
    out.frequency_hz = keys.frequency_hz;
    out.damping_ratio = keys.damping_ratio;
    // m = k/ω²; N/mm are 1000 N/m.
    out.mass_kg = given.has("mass_kg") ? keys.mass_kg : 1000.0 * keys.stiffness_n_mm / (w * w);
    if (given.has("angle_deg")) {
      out.shape = {std::cos(keys.angle_rad), std::sin(keys.angle_rad)};
    } else {
      const bool x = keys.axis == ModeKeys::Axis::x;
      out.shape = {x ? 1.0 : 0.0, x ? 0.0 : 1.0};
    }
    process_.modes.push_back(out);
  }

  void one_of(const Given& given, std::string_view one, std::string_view other) {
    if (given.has(one) && given.has(other)) {
      faults_.add(given.at({other}),
                  fmt::format("{} has both {} and {}", given.section, one, other),
                  "keep one of them");
    } else if (!given.has(one) && !given.has(other)) {
      faults_.add(given.line, fmt::format("{} has neither {} nor {}", given.section, one, other),
                  fmt::format("add {} = … or {} = …", one, other));
    }
  }

  Faults& faults_;
  Process process_;
  std::set<std::pair<std::filesystem::path, ModeKeys::Axis>> measured_;  ///< files fitted so far
};

/// toml++ throws on a syntax error; it is caught here.
Process parse_toml(std::string_view text, Faults& faults) {
  constexpr std::size_t kShown = 200;
  try {
    const toml::table root = toml::parse(text);
    return FileReader(faults).read(root);
  } catch (const toml::parse_error& error) {
    faults.add(line_of(error.source()), std::string(error.description().substr(0, kShown)),
               "correct the TOML text at this place");
  } catch (const std::exception& error) {
    faults.add(0, fmt::format("cannot be read: {}", error.what()), "give a valid process file");
  }
  return {};
}

Result<Process> first_fault(ProcessOrFaults&& all) {
  if (all) {
    return std::move(*all);
  }
  return std::unexpected(std::move(all.error().front()));
}

}  // namespace

ProcessOrFaults parse_process_all_faults(std::string_view text, const std::string& file) {
  Faults faults{file, {}};
  Process process;
  if (auto refusal = passport::unfit_text(text)) {
    refusal->file = file;
    refusal->to_do = "give a process file: TOML in plain UTF-8, like those in examples/processes/";
    faults.list.push_back(std::move(*refusal));
  } else {
    process = parse_toml(text, faults);
  }
  if (faults.list.empty()) {
    return process;
  }
  return std::unexpected(std::move(faults.list));
}

ProcessOrFaults read_process_all_faults(const std::string& path) {
  auto text = passport::read_text(path);
  if (!text) {
    text.error().to_do = "give the path of a process file (TOML)";
    return std::unexpected(std::vector<Refusal>{text.error()});
  }
  return parse_process_all_faults(*text, path);
}

Result<Process> parse_process(std::string_view text, const std::string& file) {
  return first_fault(parse_process_all_faults(text, file));
}

Result<Process> read_process(const std::string& path) {
  return first_fault(read_process_all_faults(path));
}

std::vector<std::string> response_files(const std::string& path) {
  std::vector<std::string> out;
  const auto text = passport::read_text(path);
  if (!text || passport::unfit_text(*text)) {
    return out;
  }
  try {
    const toml::table root = toml::parse(*text);
    const toml::array* const all = root["frf"].as_array();
    for (std::size_t i = 0; all != nullptr && i < all->size(); ++i) {
      if (const auto file = root["frf"][i]["file"].value<std::string>()) {
        out.push_back(response_path(path, *file).string());
      }
    }
  } catch (const toml::parse_error&) {
    out.clear();  // read_process() says what is wrong
  }
  return out;
}

}  // namespace steadyrest::chatter::offline
