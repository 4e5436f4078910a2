// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/signal/path.hpp>
#include <steadyrest/passport/file/contradictions.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/file/opcua_section.hpp>
#include <steadyrest/passport/file/override_table.hpp>
#include <steadyrest/passport/file/port_sections.hpp>
#include <steadyrest/passport/file/thermal_section.hpp>
#include <steadyrest/passport/file/words_section.hpp>
#include <steadyrest/passport/keys/section_reader.hpp>
#include <steadyrest/passport/text/text_check.hpp>
#include <steadyrest/passport/text/text_file.hpp>

// Reads the sections one by one, even after a fault, so that one run shows every fault.
// Contradictions are checked only in sections whose keys are all good.
namespace steadyrest::passport {
namespace {

using kernel::machine::Axis;
using kernel::machine::Chatter;
using kernel::machine::Compensation;
using kernel::machine::Contour;
using kernel::machine::Control;
using kernel::machine::Dialect;
using kernel::machine::Encoder;
using kernel::machine::Envelope;
using kernel::machine::Friction;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::machine::Simulation;
using kernel::machine::Spindle;

using kernel::outcome::Refusal;

constexpr std::string_view kAxisOrder = "XYZABCUVW";

bool is_rotary(std::string_view name) {
  return name == "A" || name == "B" || name == "C";
}

/// Reads the whole tree. Each section is read even when another is faulty, so that one run shows
/// every fault.
class FileReader {
 public:
  explicit FileReader(Faults& faults) : faults_(faults) {}

  Machine read(const toml::table& root) {
    SectionReader<Machine> top(faults_, top_keys(), "the top level");
    top.read(root, machine_,
             {"control", "program", "axis", "override", "spindle", "contour", "chatter",
              "compensation", "thermal", "envelope", "simulation", "lines", "recorder", "opcua"});
    section<Control>(root, "control", control_keys(), machine_.control, contradictions, true);
    program(root);
    axes(root);
    read_overrides(root, machine_, faults_);
    section<Spindle>(root, "spindle", spindle_keys(), machine_.spindle, contradictions);
    section<Contour>(root, "contour", contour_keys(), machine_.contour, contradictions);
    section<Chatter>(root, "chatter", chatter_keys(), machine_.chatter, contradictions);
    compensation(root);
    read_thermal(root, machine_.thermal, faults_);
    section<Envelope>(root, "envelope", envelope_keys(), machine_.envelope, contradictions);
    simulation(root);
    read_ports(root, machine_, faults_);
    read_opcua(root, machine_, faults_);
    return machine_;
  }

 private:
  template <class S>
  void section(const toml::table& root, std::string_view name, std::span<const Key<S>> keys, S& out,
               void (*check)(const S&, const Given&, Faults&), bool mandatory = false) {
    const std::string head = fmt::format("[{}]", name);
    const toml::table* table = table_below(faults_, root, name, head);
    if (table == nullptr) {
      if (mandatory && root.get(name) == nullptr) {
        faults_.add(0, fmt::format("there is no {}", head),
                    fmt::format("add {} with its mandatory keys", head));
      }
      return;
    }
    read_checked<S>(*table, head, keys, out, check);
  }

  template <class S>
  void read_checked(const toml::table& table, std::string head, std::span<const Key<S>> keys,
                    S& out, void (*check)(const S&, const Given&, Faults&), For axes = For::any) {
    const std::size_t before = faults_.list.size();
    SectionReader<S> reader(faults_, keys, std::move(head), axes);
    const Given given = reader.read(table, out);
    if (check != nullptr && faults_.list.size() == before) {
      check(out, given, faults_);
    }
  }

  void program(const toml::table& root) {
    const toml::table* table = table_below(faults_, root, "program", "[program]");
    if (table == nullptr) {
      return;
    }
    const std::size_t before = faults_.list.size();
    SectionReader<kernel::machine::Program> reader(faults_, program_keys(), "[program]");
    const Given given = reader.read(*table, machine_.program, {"words"});
    if (faults_.list.size() == before) {
      contradictions(machine_.program, given, faults_);
    }
    if (const toml::table* words = table_below(faults_, *table, "words", "[program.words]")) {
      read_words(*words, machine_.program.words, faults_);
    }
  }

  void axes(const toml::table& root) {
    const toml::node* node = root.get("axis");
    if (node == nullptr) {
      faults_.add(0, "there is no [[axis]]", "add one [[axis]] for each axis, two at least");
      return;
    }
    const toml::array* list = node->as_array();
    if (list == nullptr) {
      faults_.add(line_of(node->source()), "axis is not a list of sections",
                  "write [[axis]] with double brackets, once for each axis");
      return;
    }
    for (const toml::node& element : *list) {
      if (const toml::table* table = element.as_table()) {
        axis(*table);
      } else {
        faults_.add(line_of(element.source()),
                    fmt::format("axis = {} is not a section", shown(element)),
                    "write [[axis]] on a separate line, with its keys below");
        return;
      }
    }
    finish_axes(line_of(node->source()), list->size());
  }

  void axis(const toml::table& table) {
    Axis out;
    out.name.clear();
    const auto name = table["name"].value<std::string>();
    const bool known =
        name && name->size() == 1 && kAxisOrder.find(*name) != std::string_view::npos;
    const std::string head = known ? fmt::format("[[axis]] {}", *name) : std::string("[[axis]]");
    out.rotary = known && is_rotary(*name);
    const For kind = !known ? For::any : out.rotary ? For::rotary : For::linear;
    const std::size_t before = faults_.list.size();
    SectionReader<Axis> reader(faults_, axis_keys(), head, kind);
    const Given given = reader.read(table, out, {"encoder", "friction"});
    out.velocity_lag_known = given.has("velocity_lag_ms");
    if (faults_.list.size() == before) {
      if (known) {
        contradictions(out, given, faults_);
      } else {
        faults_.add(given.at({"name"}),
                    fmt::format("name = {} is not an axis", shown(*table.get("name"))),
                    "use one of X, Y, Z, U, V, W (linear), A, B, C (rotary)");
      }
    }
    if (const toml::table* encoder = table_below(faults_, table, "encoder", "[axis.encoder]")) {
      read_checked<Encoder>(*encoder, "[axis.encoder]", encoder_keys(), out.encoder, contradictions,
                            kind);
    }
    if (const toml::table* friction = table_below(faults_, table, "friction", "[axis.friction]")) {
      read_checked<Friction>(*friction, "[axis.friction]", friction_keys(), out.friction,
                             contradictions, kind);
    }
    twice(out.name, given);
    machine_.axes.push_back(std::move(out));
  }

  // Two sections of one axis would overwrite each other.
  void twice(const std::string& name, const Given& given) {
    const bool seen =
        std::any_of(machine_.axes.begin(), machine_.axes.end(),
                    [&](const Axis& axis) { return !name.empty() && axis.name == name; });
    if (seen) {
      faults_.add(given.at({"name"}), fmt::format("there are two axes {}", name),
                  "give each axis a different name");
    }
  }

  void finish_axes(std::size_t line, std::size_t count) {
    if (count < 2) {
      faults_.add(line, fmt::format("the machine has {} axis; at least 2 are needed", count),
                  "add an [[axis]]: a contour needs two");
    }
    if (faults_.list.empty()) {
      stand_ins();
    }
    if (machine_.axes.size() > kernel::signal::kMaxAxes) {
      faults_.add(line,
                  fmt::format("the machine has {} axes, counting X, Y and Z; the most is {}",
                              machine_.axes.size(), kernel::signal::kMaxAxes),
                  "leave out axes that take no part in contouring");
    }
    std::sort(machine_.axes.begin(), machine_.axes.end(), [](const Axis& a, const Axis& b) {
      return kAxisOrder.find(a.name) < kAxisOrder.find(b.name);
    });
  }

  // X, Y and Z must be the first three axes; a missing one (a lathe has no Y) gets an ideal
  // stand-in with no travel.
  void stand_ins() {
    const Axis like = machine_.axes.front();
    for (const char letter : {'X', 'Y', 'Z'}) {
      const std::string name(1, letter);
      if (std::none_of(machine_.axes.begin(), machine_.axes.end(),
                       [&](const Axis& axis) { return axis.name == name; })) {
        Axis axis;
        axis.name = name;
        axis.present = false;
        axis.servo_gain_1_s = like.servo_gain_1_s;
        axis.feed_forward = like.feed_forward;
        axis.velocity_lag_s = like.velocity_lag_s;
        axis.min_au = axis.max_au = 0.0;
        axis.encoder.count_au = 0.0;
        machine_.axes.push_back(axis);
      }
    }
  }

  void compensation(const toml::table& root) {
    const std::size_t before = faults_.list.size();
    section<Compensation>(root, "compensation", compensation_keys(), machine_.compensation,
                          contradictions);
    const Dialect needed = dialect_of(machine_.compensation.method, machine_.control.dialect);
    if (faults_.list.size() != before || needed == machine_.control.dialect) {
      return;
    }
    const toml::node_view<const toml::node> method = root["compensation"]["method"];
    faults_.add(method ? line_of(method.node()->source()) : 0,
                fmt::format("[compensation] has method = \"{}\", but the control's dialect is {}",
                            word(machine_.compensation.method), word(machine_.control.dialect)),
                fmt::format("choose a method for that dialect; \"{}\" is for {}",
                            word(machine_.compensation.method), word(needed)));
  }

  // Read after the thermal passport, because the errors belong to its modes.
  void simulation(const toml::table& root) {
    const std::size_t before = faults_.list.size();
    section<Simulation>(root, "simulation", simulation_keys(), machine_.simulation, nullptr);
    const std::size_t terms = machine_.thermal.terms();
    const auto check = [&](std::string_view key, const std::vector<double>& errors) {
      if (errors.size() > terms) {
        faults_.add(line_of(root["simulation"][key].node()->source()),
                    fmt::format("{} has {} entries; the thermal passport has {} modes and ambient "
                                "inputs",
                                key, errors.size(), terms),
                    terms == 0 ? "remove it, or add [[thermal.axis]]"
                               : "give one for each, or fewer: the last applies to the rest");
      }
    };
    if (faults_.list.size() == before) {
      check("thermal_tau_error_percent", machine_.simulation.thermal_tau_error_ratio);
      check("thermal_gain_error_percent", machine_.simulation.thermal_gain_error_ratio);
    }
  }

  Faults& faults_;
  Machine machine_;
};

std::string without_prefix(std::string_view description) {
  return std::string(description.substr(0, 200));
}

/// toml++ throws on a syntax error; that ends here.
void parse_toml(std::string_view text, Faults& faults, Machine& machine) {
  try {
    const toml::table root = toml::parse(text);
    machine = FileReader(faults).read(root);
  } catch (const toml::parse_error& error) {
    faults.add(line_of(error.source()), without_prefix(error.description()),
               "correct the TOML text at this place");
  } catch (const std::exception& error) {
    faults.add(0, fmt::format("cannot be read: {}", error.what()), "give a valid machine file");
  }
}

std::string unreadable(const std::string& path, std::string& text) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return "is a folder";
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    return fmt::format("cannot be opened: {}", std::strerror(errno));
  }
  // One byte more than allowed is enough to refuse; a 200 MB file or a device is never read whole.
  text.resize(kMaxFileBytes + 1);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  text.shrink_to_fit();  // some texts are kept as long as a run lasts
  return in.bad() ? "reading stopped before its end" : "";
}

kernel::outcome::Result<Machine> first_fault(AllFaults&& all) {
  if (all) {
    return std::move(*all);
  }
  return std::unexpected(std::move(all.error().front()));
}

}  // namespace

/// Bytes first: the TOML parser must not see anything that could overflow its stack.
AllFaults parse_all_faults(std::string_view text, const std::string& file) {
  Faults faults{file, {}};
  Machine machine;
  if (auto refusal = unfit_text(text)) {
    refusal->file = file;
    faults.list.push_back(std::move(*refusal));
  } else {
    parse_toml(text, faults, machine);
  }
  if (faults.list.empty()) {
    machine.file = file;
    return machine;
  }
  return std::unexpected(std::move(faults.list));
}

kernel::outcome::Result<std::string> read_text(const std::string& path) {
  std::string text;
  if (const std::string why = unreadable(path, text); !why.empty()) {
    return kernel::outcome::refuse(path, why, "give the path of a machine file (TOML)");
  }
  return text;
}

AllFaults read_all_faults(const std::string& path) {
  const auto text = read_text(path);
  if (!text) {
    return std::unexpected(std::vector<Refusal>{text.error()});
  }
  return parse_all_faults(*text, path);
}

kernel::outcome::Result<Machine> parse(std::string_view text, const std::string& file) {
  return first_fault(parse_all_faults(text, file));
}

kernel::outcome::Result<Machine> read(const std::string& path) {
  return first_fault(read_all_faults(path));
}

}  // namespace steadyrest::passport
