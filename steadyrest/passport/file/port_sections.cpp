// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include <steadyrest/kernel/link/host_port.hpp>
#include <steadyrest/passport/file/port_sections.hpp>

// A line that is named twice, or a word that is too narrow for its table, would make the layer
// write another word than it means: both are refused here, before any port is opened.
namespace steadyrest::passport {
namespace {

using kernel::machine::kNoLine;
using kernel::machine::Lines;
using kernel::machine::LinesKind;
using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::machine::OverrideWires;
using kernel::machine::PortKind;
using kernel::machine::Recorder;
using kernel::machine::RecorderKind;
using kernel::machine::Wiring;

/// The section `name`; null when absent, a fault when it is something else.
const toml::table* section_of(const toml::table& parent, std::string_view name,
                              std::string_view head, Faults& faults) {
  const toml::node* node = parent.get(name);
  if (node == nullptr) {
    return nullptr;
  }
  if (node->as_table() == nullptr) {
    faults.add(line_of(node->source()), fmt::format("{} = {} is not a section", name, shown(*node)),
               fmt::format("write {} on a separate line, with its keys below", head));
  }
  return node->as_table();
}

void check_kind(const Lines& lines, const Given& given, Faults& faults) {
  const bool network = lines.kind == LinesKind::modbus_tcp;
  const bool modbus = network || lines.kind == LinesKind::modbus_rtu;
  if (network && lines.address.empty()) {
    faults.add(given.at({"kind"}), R"([lines] has no address for kind = "modbus_tcp")",
               R"(add address = "HOST" or "HOST:PORT")");
  }
  if (network && !lines.address.empty() && !kernel::link::host_and_port(lines.address, "502")) {
    faults.add(given.at({"address"}),
               fmt::format("address = \"{}\" is no HOST or HOST:PORT", lines.address),
               "give the module's name or number, and its port (1 … 65535) if it is not 502");
  }
  if (!network && lines.device.empty()) {
    faults.add(given.at({"kind"}), "[lines] has no device for this kind",
               "add device = \"/dev/…\": the serial device, the GPIO chip or the comedi device");
  }
  const auto check_registers = [&](std::string_view key, const std::vector<std::uint32_t>& all) {
    if (!all.empty() && (!modbus || all.size() % 2 != 0)) {
      faults.add(given.at({key}),
                 modbus ? fmt::format("{} has {} entries", key, all.size())
                        : fmt::format("{} is for Modbus modules", key),
                 modbus ? "write an address and its value in turn" : "leave it out");
    }
  };
  check_registers("watchdog_registers", lines.watchdog_registers);
  check_registers("watchdog_reset", lines.watchdog_reset);
  if (!modbus && lines.watchdog_s > 0.0) {
    faults.add(given.at({"watchdog_ms"}), "watchdog_ms is for Modbus modules",
               "leave it out: GPIO lines and comedi cards keep their levels; wire heartbeat to a "
               "watchdog relay");
  }
  if (lines.wiring == Wiring::through && lines.watchdog_s <= 0.0) {
    faults.add(given.at({"wiring"}),
               "wiring = \"through\" without an output watchdog: a dead layer would leave its last "
               "word in force for ever",
               "set watchdog_ms of a module that has one, or use wiring = \"relay\"");
  }
}

void check_wires(const OverrideWires& wires, const Given& given, Wiring wiring,
                 const OverrideTable& table, Faults& faults) {
  if (wires.out.size() != wires.panel.size()) {
    faults.add(given.at({"out"}),
               fmt::format("{}: {} lines in out, {} in panel", given.section, wires.out.size(),
                           wires.panel.size()),
               "wire every bit of the word both ways");
  }
  if (wires.mask == kNoLine && wiring != Wiring::through) {
    faults.add(given.line, fmt::format("{} has no mask", given.section),
               "add mask = the output that puts the layer's word in force");
  }
  std::uint32_t widest = 0;
  for (const std::uint32_t code : table.code) {
    widest = std::max(widest, code);
  }
  const auto needed = static_cast<std::size_t>(std::bit_width(widest));
  if (table.ratio.size() < 2) {
    faults.add(given.line, fmt::format("{} is wired, but its override has no table", given.section),
               "add the [override] section of that switch");
  } else if (wires.panel.size() < needed) {
    faults.add(given.at({"panel"}),
               fmt::format("{} has {} of the {} lines that the table's code {:#b} needs",
                           given.section, wires.panel.size(), needed, widest),
               "wire all bits of the word, or correct the table");
  }
}

/// One line for two purposes.
void check_twice(std::vector<std::uint32_t> lines, std::string_view what, const Given& given,
                 Faults& faults) {
  std::erase(lines, kNoLine);
  std::ranges::sort(lines);
  const auto twice = std::ranges::adjacent_find(lines);
  if (twice != lines.end()) {
    faults.add(given.line, fmt::format("{} {} has two purposes", what, *twice),
               "give each line one purpose");
  }
}

/// A Modbus address has 16 bits: a larger one would be another line's.
void check_addresses(const Lines& lines, std::uint32_t last_input, std::uint32_t last_output,
                     const Given& given, Faults& faults) {
  constexpr std::uint32_t kLastModbusAddress = 65535;
  constexpr std::uint32_t kRegisterLines = 16;
  const std::uint32_t lines_each = lines.registers ? kRegisterLines : 1;
  const auto check = [&](std::string_view key, std::uint32_t first, std::uint32_t last) {
    if (first + last / lines_each > kLastModbusAddress) {
      faults.add(given.at({key}),
                 fmt::format("{} = {}: line {} would be at address {}, beyond {}", key, first, last,
                             first + last / lines_each, kLastModbusAddress),
                 "correct the address or the lines' numbers");
    }
  };
  check("first_input", lines.first_input, last_input);
  check("first_output", lines.first_output, last_output);
  if (lines.output_copy != lines.first_output) {
    check("output_copy", lines.output_copy, last_output);
  }
  // Setting the watchdog would set outputs.
  const auto check_watchdog = [&](std::string_view key, const std::vector<std::uint32_t>& all) {
    for (std::size_t i = 0; lines.registers && i < all.size(); i += 2) {
      if (all[i] >= lines.first_output && all[i] <= lines.first_output + last_output / lines_each) {
        faults.add(given.at({key}), fmt::format("{}: {} is a register of outputs", key, all[i]),
                   "give the watchdog's registers by the module's manual");
      }
    }
  };
  check_watchdog("watchdog_registers", lines.watchdog_registers);
  check_watchdog("watchdog_reset", lines.watchdog_reset);
}

/// On one comedi subdevice all lines from the lowest to the highest output are turned to outputs.
void check_subdevice(const std::vector<std::uint32_t>& inputs,
                     const std::vector<std::uint32_t>& outputs, const Given& given,
                     Faults& faults) {
  const auto [first, last] = std::ranges::minmax(outputs);
  for (const std::uint32_t input : inputs) {
    if (input >= first && input <= last) {
      faults.add(
          given.at({"output_device"}),
          fmt::format("input {} is among the outputs {} … {} of its subdevice", input, first, last),
          "put inputs and outputs into separate ranges, or on separate subdevices");
      return;
    }
  }
}

/// What can only be seen of all lines together.
void check_reach(const Lines& lines, std::vector<std::uint32_t> inputs,
                 std::vector<std::uint32_t> outputs, const Given& given, Faults& faults) {
  std::erase(inputs, kNoLine);
  std::erase(outputs, kNoLine);
  if (inputs.empty() || outputs.empty()) {
    return;
  }
  if (lines.kind == LinesKind::modbus_tcp || lines.kind == LinesKind::modbus_rtu) {
    check_addresses(lines, std::ranges::max(inputs), std::ranges::max(outputs), given, faults);
  } else if (lines.kind == LinesKind::comedi && lines.input_device == lines.output_device) {
    check_subdevice(inputs, outputs, given, faults);
  }
}

void check_all_lines(const Lines& lines, const Given& given, Faults& faults) {
  std::vector<std::uint32_t> inputs = {lines.running, lines.cutting, lines.locked, lines.modulate};
  std::vector<std::uint32_t> outputs = {lines.heartbeat, lines.feed.mask, lines.spindle.mask};
  for (const OverrideWires* wires : {&lines.feed, &lines.spindle}) {
    inputs.insert(inputs.end(), wires->panel.begin(), wires->panel.end());
    outputs.insert(outputs.end(), wires->out.begin(), wires->out.end());
  }
  check_twice(inputs, "input", given, faults);
  check_twice(outputs, "output", given, faults);
  check_reach(lines, inputs, outputs, given, faults);
  if (lines.wiring == Wiring::plc && lines.heartbeat == kNoLine) {
    faults.add(given.at({"wiring"}), "wiring = \"plc\" without a heartbeat",
               "add heartbeat = the output that the PLC watches");
  }
  if (lines.feed.out.empty() && lines.spindle.out.empty()) {
    faults.add(given.line, "[lines] wires no override", "add [lines.feed] or [lines.spindle]");
  }
}

void wires_at(const toml::table& parent, std::string_view name, const OverrideTable& table,
              Wiring wiring, OverrideWires& out, Faults& faults) {
  const std::string head = fmt::format("[lines.{}]", name);
  const toml::table* section = section_of(parent, name, head, faults);
  if (section == nullptr) {
    return;
  }
  const std::size_t before = faults.list.size();
  SectionReader<OverrideWires> reader(faults, wires_keys(), head);
  const Given given = reader.read(*section, out);
  if (faults.list.size() == before) {
    check_wires(out, given, wiring, table, faults);
  }
}

void read_lines(const toml::table& section, Machine& out, Faults& faults) {
  const std::size_t before = faults.list.size();
  SectionReader<Lines> reader(faults, lines_keys(), "[lines]");
  const Given given = reader.read(section, out.lines, {"feed", "spindle"});
  if (!given.has("output_copy")) {
    out.lines.output_copy = out.lines.first_output;
  }
  if (faults.list.size() == before) {
    check_kind(out.lines, given, faults);
  }
  if (faults.list.size() == before && out.lines.programmed_rev_s > out.spindle.max_rev_s) {
    faults.add(given.at({"programmed_rpm"}),
               fmt::format("programmed_rpm = {:g} is above the spindle's {:g}",
                           60.0 * out.lines.programmed_rev_s, 60.0 * out.spindle.max_rev_s),
               "give the speed that the program has, or the spindle's max_rpm");
  }
  wires_at(section, "feed", out.feed_override, out.lines.wiring, out.lines.feed, faults);
  wires_at(section, "spindle", out.spindle_override, out.lines.wiring, out.lines.spindle, faults);
  if (faults.list.size() == before) {
    check_all_lines(out.lines, given, faults);
  }
}

void check_recorder(const Machine& machine, const Given& given, Faults& faults) {
  const Recorder& recorder = machine.recorder;
  const bool counter = recorder.kind == RecorderKind::counter;
  if (recorder.device.empty() && !counter) {
    faults.add(given.line, "[recorder] has no device",
               "add device = \"/dev/…\": the serial device or the GPIO chip");
  }
  if (recorder.kind == RecorderKind::serial) {
    if (!recorder.inputs.empty()) {
      faults.add(given.at({"inputs"}), "inputs are not for kind = \"serial\"", "leave them out");
    }
    return;
  }
  const std::size_t encoders = encoder_count(machine);
  if (recorder.inputs.size() != 2 * encoders) {
    faults.add(given.at({"inputs"}),
               fmt::format("inputs has {} entries; {} encoders need {}", recorder.inputs.size(),
                           encoders, 2 * encoders),
               counter ? "give the numbers of counter and count for each axis, then the spindle"
                       : "give the lines of channels A and B for each axis, then the spindle");
  } else if (!counter) {
    check_twice(recorder.inputs, "line", given, faults);
  } else {
    std::vector<std::uint32_t> counts;
    for (std::size_t i = 0; i + 1 < recorder.inputs.size(); i += 2) {
      counts.push_back(1024 * recorder.inputs[i] + recorder.inputs[i + 1]);
    }
    std::ranges::sort(counts);
    if (const auto twice = std::ranges::adjacent_find(counts); twice != counts.end()) {
      faults.add(given.at({"inputs"}),
                 fmt::format("counter {} count {} is given for two encoders", *twice / 1024,
                             *twice % 1024),
                 "give each encoder a count of its own");
    }
  }
}

/// One position for each axis of the file; in `start_mm` then for missing ones too.
void place_start(Machine& machine, const Given& given, Faults& faults) {
  const std::vector<double> shown = std::exchange(machine.recorder.start_mm, {});
  const auto present = static_cast<std::size_t>(
      std::ranges::count_if(machine.axes, &kernel::machine::Axis::present));
  if (shown.empty()) {
    return;
  }
  if (shown.size() != present) {
    faults.add(
        given.at({"start_mm"}),
        fmt::format("start_mm has {} entries; the machine has {} axes", shown.size(), present),
        "give one for each axis, X first");
    return;
  }
  for (auto next = shown.begin(); const auto& axis : machine.axes) {
    const double start_mm = axis.present ? *next++ : 0.0;
    if (axis.present && !axis.rotary && (start_mm < axis.min_au || start_mm > axis.max_au)) {
      faults.add(given.at({"start_mm"}),
                 fmt::format("start_mm: {} = {:g} is outside of its travel, {:g} … {:g}", axis.name,
                             start_mm, axis.min_au, axis.max_au),
                 "give the positions of the axes when the layer starts, in machine coordinates");
    }
    machine.recorder.start_mm.push_back(start_mm);
  }
}

void read_recorder(const toml::table& section, Machine& out, Faults& faults) {
  const std::size_t before = faults.list.size();
  out.recorder.fitted = true;
  SectionReader<Recorder> reader(faults, recorder_keys(), "[recorder]");
  const Given given = reader.read(section, out.recorder);
  if (faults.list.size() == before) {
    check_recorder(out, given, faults);
  }
  if (faults.list.size() == before) {
    place_start(out, given, faults);
  }
}

}  // namespace

void read_ports(const toml::table& root, Machine& out, Faults& faults) {
  const std::size_t before = faults.list.size();
  if (const toml::table* lines = section_of(root, "lines", "[lines]", faults)) {
    read_lines(*lines, out, faults);
  } else if (out.port == PortKind::lines && faults.list.size() == before) {
    faults.add(0, "port = \"lines\", but there is no [lines]",
               "add [lines] with its kind and the wires of an override");
  }
  if (const toml::table* recorder = section_of(root, "recorder", "[recorder]", faults)) {
    read_recorder(*recorder, out, faults);
  }
}

}  // namespace steadyrest::passport
