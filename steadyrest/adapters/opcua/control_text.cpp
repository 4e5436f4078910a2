// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/control_text.hpp>
#include <steadyrest/adapters/opcua/control_texts.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

// A template's line that begins with @ is repeated for each axis. {s:N}, {o:N}, {w:N} are R
// parameters of the three blocks, {w:12+2i} one for each axis, {id} the next action's number.
// {HAS_SPINDLE} and its like make the line a comment where the machine has none.
namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Machine;
using kernel::machine::OverrideTable;
using kernel::machine::Quantity;
using kernel::outcome::refuse;
using kernel::outcome::Result;

constexpr std::uint32_t kLastAction = 255;
/// Added to the limits of an order (%, mm): 1.11 / 0.01 is a little more than 111.
constexpr double kRounding = 1e-6;
constexpr std::string_view kWithout = "; not on this machine: ";

using Fields = std::map<std::string, std::string, std::less<>>;

struct Axis {
  std::string name;
  std::string machine_name;
};

/// Without an exponent: the control writes 5EX-5 and takes 5e-05 for an error. R parameters have
/// eight decimals.
std::string number(double value) {
  std::string out = fmt::format("{:.8f}", value);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.ends_with('.')) {
    out.pop_back();
  }
  return out;
}

/// For a comment: what ends a line there would begin a block of the program.
std::string comment(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
  return text;
}

std::vector<Axis> axes_of(const Machine& machine) {
  std::vector<Axis> out;
  std::istringstream names(machine.opcua.machine_axes);
  for (const auto& axis : machine.axes) {
    if (axis.present) {
      std::string own;
      names >> own;
      out.push_back({axis.name, own.empty() ? axis.name + "1" : own});
    }
  }
  return out;
}

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 16 && std::ranges::all_of(text, [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_';
  });
}

bool writes(const Machine& machine, Quantity quantity) {
  return std::ranges::find(machine.opcua.writes, quantity,
                           &kernel::machine::OpcUaPlace::quantity) != machine.opcua.writes.end();
}

/// The PLC masks the switches; no action writes an override.
bool has_plc_block(const Machine& machine) {
  return writes(machine, Quantity::feed_position) || writes(machine, Quantity::spindle_position);
}

bool has_spindle(const Machine& machine) {
  return machine.spindle_override.ratio.size() > 1;
}

/// Rate of the feed's way back (1/s). The actions do not bring it back faster than the spindle:
/// feed per tooth would rise.
double hand_back_1_s(const Machine& machine) {
  return has_spindle(machine)
             ? std::min(machine.opcua.hand_back_1_s, machine.envelope.spindle_slew_1_s)
             : machine.opcua.hand_back_1_s;
}

/// One position of the switch in the PLC's way back: the widest one takes so long at that rate.
double position_s(const Machine& machine) {
  double widest = 0.0;
  for (const auto* const table : {&machine.feed_override, &machine.spindle_override}) {
    for (std::size_t i = 1; i < table->ratio.size(); ++i) {
      widest = std::max(widest, table->ratio[i] - table->ratio[i - 1]);
    }
  }
  return std::max(0.02, std::ceil(1e3 * widest / hand_back_1_s(machine) - 1e-6) * 1e-3);
}

/// What the actions add in a cycle must be something where R parameters end.
bool too_slow(double per_cycle) {
  return per_cycle > 0.0 && number(per_cycle) == "0";
}

int gray(const kernel::machine::OverrideTable& table) {
  return table.coding == kernel::machine::Coding::gray ? 1 : 0;
}

std::string scl_cases(const kernel::machine::OverrideTable& table, bool to_position,
                      std::string_view place) {
  std::string out;
  for (std::size_t i = 0; i < table.code.size(); ++i) {
    out += to_position ? fmt::format("  {}: panel := {};   // {:g} %\n", table.code[i], i + 1,
                                     100.0 * table.ratio[i])
                       : fmt::format("    {}: {} := B#16#{:02X};   // {:g} %\n", i + 1, place,
                                     table.code[i], 100.0 * table.ratio[i]);
  }
  return out;
}

Fields fields_of(const Machine& machine, const std::vector<Axis>& axes) {
  const auto& config = machine.opcua;
  const double ipo_s = machine.control.interpolator_period_s;
  const auto& envelope = machine.envelope;
  const std::uint32_t spindle_db = 30 + config.spindle_axis;
  const bool plc = has_plc_block(machine);
  const bool spindle = has_spindle(machine);
  const auto unless = [](bool has) { return has ? std::string() : std::string(kWithout); };
  const auto dead_cycles = static_cast<int>(std::floor(config.dead_man_s / ipo_s + 1e-9));
  return {
      {"NAME", comment(machine.name)},
      {"FILE", machine.file.empty() ? "M" : comment(machine.file)},
      {"IPO_MS", number(1e3 * ipo_s)},
      {"IPO_S", number(ipo_s)},
      {"DEAD_MS", number(1e3 * config.dead_man_s)},
      {"DEAD_CYCLES", number(dead_cycles)},
      {"RISE", number(100.0 * hand_back_1_s(machine) * ipo_s)},
      {"RISE_PERCENT_S", number(100.0 * hand_back_1_s(machine))},
      {"SPINDLE_RISE", number(100.0 * envelope.spindle_slew_1_s * ipo_s)},
      {"FEED_MAX", number(100.0 * envelope.max_feed_ratio + kRounding)},
      {"SPINDLE_MIN",
       number(std::max(0.0, 100.0 * std::min(1.0, envelope.min_spindle_ratio) - kRounding))},
      {"SPINDLE_MAX", number(100.0 * std::max(1.0, envelope.max_spindle_ratio) + kRounding)},
      {"SPINDLE", config.spindle},
      {"OFFSET_MOST", number(envelope.max_offset_mm + kRounding)},
      {"AXES", std::to_string(axes.size())},
      {"OFFSET_STEP", number(envelope.offset_slew_mm_s * ipo_s)},
      {"R_NEEDED",
       std::to_string(std::max({config.first_sample + kernel::machine::sample_count(axes.size()),
                                config.first_order + kernel::machine::order_count(axes.size()),
                                config.first_work + kernel::machine::work_count(axes.size())}))},
      {"HAS_SPINDLE", unless(spindle)},
      {"BY_ACTIONS", unless(!plc)},
      {"SPINDLE_BY_ACTIONS", unless(spindle && !plc)},
      {"HAS_OFFSETS", unless(has_offsets(machine))},
      {"FEED_EXCEEDS", unless(!plc && machine.feed_override.layer_may_exceed_panel)},
      {"SPINDLE_EXCEEDS",
       unless(spindle && !plc && machine.spindle_override.layer_may_exceed_panel)},
      {"DB", std::to_string(config.plc_block)},
      {"IDB", std::to_string(config.plc_block + 1)},
      {"AXIS_DB", std::to_string(spindle_db)},
      {"GRAY", std::to_string(gray(machine.feed_override))},
      {"SPINDLE_GRAY", std::to_string(gray(machine.spindle_override))},
      {"STEP_MS", number(std::round(1e3 * position_s(machine)))},
      {"CHANNEL_DB", std::to_string(config.channel_db())},
      {"FEED_TO_POSITION", scl_cases(machine.feed_override, true, "")},
      {"POSITION_TO_FEED",
       scl_cases(machine.feed_override, false, fmt::format("DB{}.DB4", config.channel_db()))},
      {"SPINDLE_TO_POSITION", scl_cases(machine.spindle_override, true, "")},
      {"POSITION_TO_SPINDLE",
       scl_cases(machine.spindle_override, false, fmt::format("DB{}.DB19", spindle_db))},
  };
}

/// Fills in templates line by line.
class Filler {
 public:
  Filler(const Machine& machine, std::vector<Axis> axes)
      : axes_(std::move(axes)),
        fields_(fields_of(machine, axes_)),
        next_action_(machine.opcua.first_action) {
    const std::size_t count = axes_.size();
    blocks_['s'] = {machine.opcua.first_sample, kernel::machine::sample_count(count)};
    blocks_['o'] = {machine.opcua.first_order, kernel::machine::order_count(count)};
    blocks_['w'] = {machine.opcua.first_work, kernel::machine::work_count(count)};
    fields_["FIRST_ID"] = std::to_string(next_action_);
  }

  std::string fill(std::string_view text) {
    std::string out;
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
      const bool each = line.starts_with('@');
      for (std::size_t i = 0; i < (each ? axes_.size() : 1); ++i) {
        out += fill_line(each ? line.substr(1) : line, i) + "\n";
      }
    }
    return out;
  }
  [[nodiscard]] std::uint32_t next_action() const noexcept { return next_action_; }
  void put(const std::string& name, const std::string& value) { fields_[name] = value; }

 private:
  struct Block {
    std::size_t first = 0;
    std::size_t count = 0;
  };

  std::string fill_line(const std::string& line, std::size_t axis) {
    std::string out;
    std::size_t at = 0;
    while (at < line.size()) {
      const std::size_t open = line.find('{', at);
      const std::size_t close = open == std::string::npos ? open : line.find('}', open);
      if (close == std::string::npos) {
        return out + line.substr(at);
      }
      out += line.substr(at, open - at) + field(line.substr(open + 1, close - open - 1), axis, out);
      at = close + 1;
    }
    // Several cases of a switch end in a line's end of their own.
    if (out.ends_with('\n')) {
      out.pop_back();
    }
    return out;
  }

  std::string field(const std::string& name, std::size_t axis, const std::string& before) {
    if (name == "id") {
      return before.starts_with(';') ? "n" : std::to_string(next_action_++);
    }
    if (name == "AXIS") {
      return axes_[axis].name;
    }
    if (name == "MACHINE_AXIS") {
      return axes_[axis].machine_name;
    }
    if (name.size() > 2 && name[1] == ':') {
      const Block& block = blocks_[name[0]];
      const std::string place = name.substr(2);
      if (place == "LAST") {
        return std::to_string(block.first + block.count - 1);
      }
      const std::size_t plus = place.find('+');
      const std::size_t step = plus == std::string::npos ? 0 : std::stoul(place.substr(plus + 1));
      return std::to_string(block.first + std::stoul(place) + step * axis);
    }
    const auto found = fields_.find(name);
    return found == fields_.end() ? "{" + name + "}" : found->second;
  }

  std::vector<Axis> axes_;
  Fields fields_;
  std::map<char, Block> blocks_;
  std::uint32_t next_action_;
};

/// From the last heartbeat until the panel is in force.
double way_back_s(const Machine& machine, const OverrideTable& table, double rate_1_s,
                  double from_ratio, double panel_ratio) noexcept {
  if (has_plc_block(machine)) {
    // The block climbs every position, those that repeat a value too.
    const auto positions = std::ranges::count_if(
        table.ratio, [&](double ratio) { return ratio > from_ratio && ratio <= panel_ratio; });
    const auto repeated = std::max<std::ptrdiff_t>(std::ranges::count(table.ratio, from_ratio), 1);
    return machine.opcua.dead_man_s +
           static_cast<double>(positions + repeated + 1) * position_s(machine);
  }
  return machine.opcua.dead_man_s + std::max(0.0, panel_ratio - from_ratio) / rate_1_s +
         2.0 * machine.control.interpolator_period_s;
}

}  // namespace

bool has_offsets(const Machine& machine) noexcept {
  return machine.envelope.max_offset_mm > 0.0 && writes(machine, Quantity::axis_offset_mm);
}

Result<std::vector<ControlText>> control_texts(const Machine& machine) {
  if (machine.opcua.endpoint.empty()) {
    return refuse(machine.file, "there is no [opcua]", "add it, with endpoint and mapping");
  }
  const std::vector<Axis> axes = axes_of(machine);
  for (const Axis& axis : axes) {
    if (!is_name(axis.machine_name)) {
      return refuse(machine.file, "machine_axes has the name " + axis.machine_name,
                    "write names such as X1, with blanks between");
    }
  }
  if (!is_name(machine.opcua.spindle)) {
    return refuse(machine.file, "spindle = \"" + machine.opcua.spindle + "\"",
                  "write S1, for example");
  }
  const double ipo_s = machine.control.interpolator_period_s;
  if (too_slow(100.0 * hand_back_1_s(machine) * ipo_s) ||
      (has_spindle(machine) && too_slow(100.0 * machine.envelope.spindle_slew_1_s * ipo_s))) {
    return refuse(machine.file, "the way back is slower than an R parameter can hold in a cycle",
                  "give a larger hand_back_percent_s or spindle_slew_percent_s");
  }
  if (has_offsets(machine) &&
      too_slow(machine.envelope.offset_slew_mm_s * machine.control.interpolator_period_s)) {
    return refuse(machine.file,
                  fmt::format("offset_slew_um_s = {:g} is less than an R parameter can hold in a "
                              "cycle of {:g} ms",
                              1e3 * machine.envelope.offset_slew_mm_s,
                              1e3 * machine.control.interpolator_period_s),
                  "give a faster one, or max_offset_um = 0 for no offsets");
  }
  // The number of actions is written at the top, so the text is filled in twice.
  Filler counting(machine, axes);
  static_cast<void>(counting.fill(kActionsTemplate));
  const std::uint32_t actions = counting.next_action() - machine.opcua.first_action;
  if (counting.next_action() - 1 > kLastAction) {
    return refuse(machine.file,
                  fmt::format("first_action = {}: {} actions are needed, and {} is the last number",
                              machine.opcua.first_action, actions, kLastAction),
                  fmt::format("give {} or less", kLastAction + 1 - actions));
  }
  Filler filler(machine, axes);
  filler.put("ACTIONS", std::to_string(actions));
  filler.put("LAST_ID", std::to_string(counting.next_action() - 1));
  std::vector<ControlText> out;
  out.push_back({"STEADYREST.SPF", filler.fill(kActionsTemplate)});
  out.push_back({"PROG_EVENT.SPF", filler.fill(kEventTemplate)});
  if (has_plc_block(machine)) {
    out.push_back({"STEADYREST.SCL", filler.fill(kPlcTemplate)});
  }
  return out;
}

double neutral_after_s(const Machine& machine, double from_ratio, double panel_ratio) noexcept {
  return way_back_s(machine, machine.feed_override, hand_back_1_s(machine), from_ratio,
                    panel_ratio);
}

double longest_hand_back_s(const Machine& machine) noexcept {
  const auto top = [](const OverrideTable& table) {
    return table.ratio.empty() ? 1.0 : std::max(1.0, table.ratio.back());
  };
  const double feed_s = neutral_after_s(machine, 0.0, top(machine.feed_override));
  const double spindle_s =
      way_back_s(machine, machine.spindle_override, machine.envelope.spindle_slew_1_s,
                 std::min(1.0, machine.envelope.min_spindle_ratio), top(machine.spindle_override));
  return has_spindle(machine) ? std::max(feed_s, spindle_s) : feed_s;
}

}  // namespace steadyrest::adapters::opcua
