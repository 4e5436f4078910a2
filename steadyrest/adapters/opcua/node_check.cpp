// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/frame.hpp>
#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::Quantity;
using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr std::array<std::string_view, 11> kNumeric = {"Boolean", "SByte", "Byte",   "Int16",
                                                       "UInt16",  "Int32", "UInt32", "Int64",
                                                       "UInt64",  "Float", "Double"};

std::string_view word_of(Quantity quantity) {
  return kernel::machine::kQuantityWords[static_cast<std::size_t>(quantity)];
}

bool numeric(const std::string& type) {
  return std::ranges::find(kNumeric, type) != kNumeric.end();
}

/// The value's status says what kind of fault it is.
std::optional<Refusal> unreadable(const Answer::Checked& shown, const NodePlan::Node& node,
                                  const kernel::machine::OpcUa& config) {
  if (shown.status == 0) {
    return std::nullopt;
  }
  const std::string& name = shown.status_name;
  const auto words = [&](std::string_view what, std::string_view to_do) {
    return bad_input(config.mapping, fmt::format("{} {} ({})", node.id, what, name),
                     std::string(to_do));
  };
  if (name == "BadNodeIdUnknown" || name == "BadAttributeIdInvalid" || name == "BadNodeIdInvalid" ||
      name == "BadNotFound") {
    return words("is not on this control",
                 "another control or firmware has other names, and upper and lower case count: "
                 "correct the mapping, or raise MD28050 if it is an R parameter");
  }
  if (name == "BadUserAccessDenied" || name == "BadNotReadable") {
    return words("may not be read by this user",
                 "give the user SinuReadAll, or the right it needs");
  }
  return words("cannot be read", "see the control's manual for this status");
}

std::optional<Refusal> unfit(const Answer::Checked& shown, const NodePlan::Node& node, bool written,
                             const kernel::machine::OpcUa& config) {
  if (auto fault = unreadable(shown, node, config)) {
    return fault;
  }
  const auto refusal = [&](std::string what, std::string to_do) {
    return bad_input(config.mapping, fmt::format("{} {}", node.id, what), std::move(to_do));
  };
  if (node.text ? shown.type != "String" : !numeric(shown.type)) {
    return refusal(fmt::format("has the type {}; it must be {}", shown.type,
                               node.text ? "String" : "a number"),
                   "map the quantity to another node");
  }
  if (node.length > 0 && shown.length < static_cast<std::int64_t>(node.length)) {
    return refusal(
        shown.length < 0
            ? fmt::format("is a single value; the mapping wants {} in an array", node.length)
            : fmt::format("has {} values; the mapping wants {}", shown.length, node.length),
        "correct the mapping, or raise MD28050 if it is a range of R parameters");
  }
  if (node.length == 0 && shown.length >= 0) {
    return refusal(fmt::format("is an array of {}; the mapping wants a single value", shown.length),
                   "give length and index in the mapping");
  }
  if (written && shown.writable.has_value() && !*shown.writable) {
    return refusal("may not be written by this user",
                   fmt::format("give the user {} the right to write R parameters "
                               "(docs/opcua.md, Users)",
                               config.user.empty() ? "anonymous" : config.user));
  }
  return std::nullopt;
}

}  // namespace

std::vector<Refusal> node_faults(const Answer& answer, const NodePlan& plan,
                                 const kernel::machine::OpcUa& config) {
  std::vector<Refusal> out;
  const std::size_t reads = plan.reads().size();
  if (answer.nodes.size() != reads + plan.writes().size()) {
    out.push_back(bad_input("the OPC UA bridge checked other nodes than asked",
                            "use the bridge that belongs to this program"));
    return out;
  }
  for (std::size_t i = 0; i < answer.nodes.size(); ++i) {
    const bool written = i >= reads;
    const NodePlan::Node& node = written ? plan.writes()[i - reads] : plan.reads()[i];
    if (auto fault = unfit(answer.nodes[i], node, written, config)) {
      out.push_back(*std::move(fault));
    }
  }
  return out;
}

std::vector<Refusal> override_faults(const Reading& reading,
                                     const kernel::machine::Machine& machine) {
  const auto most = [](const kernel::machine::OverrideTable& table) {
    constexpr double kMost = 2.0;
    return 100.0 * (table.ratio.empty() ? kMost : std::max(kMost, table.ratio.back()));
  };
  const std::array<std::pair<Quantity, const kernel::machine::OverrideTable*>, 6> overrides = {
      {{Quantity::feed_panel_percent, &machine.feed_override},
       {Quantity::feed_effective_percent, &machine.feed_override},
       {Quantity::rapid_panel_percent, &machine.rapid_override},
       {Quantity::rapid_effective_percent, &machine.rapid_override},
       {Quantity::spindle_panel_percent, &machine.spindle_override},
       {Quantity::spindle_effective_percent, &machine.spindle_override}}};
  std::vector<Refusal> out;
  for (const auto& [quantity, table] : overrides) {
    const double shown = reading[quantity];
    if (shown < 0.0 || shown > most(*table)) {
      out.push_back(bad_input(
          machine.opcua.mapping,
          fmt::format("{} is {:g} now; allowed: 0 … {:g}", word_of(quantity), shown, most(*table)),
          "correct its node, scale or offset in the mapping"));
    }
  }
  return out;
}

std::vector<Refusal> position_faults(const Reading& reading,
                                     const kernel::machine::Machine& machine) {
  constexpr double kBeyond_mm = 1.0;
  std::vector<Refusal> out;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto& axis = machine.axes[i];
    for (const Quantity quantity : {Quantity::command_mm, Quantity::actual_mm}) {
      const double shown = reading(quantity, i);
      if (axis.present && !axis.rotary &&
          (shown < axis.min_au - kBeyond_mm || shown > axis.max_au + kBeyond_mm)) {
        out.push_back(bad_input(
            machine.opcua.mapping,
            fmt::format("{} of {} is {:g} now, beyond its travel of {:g} … {:g}", word_of(quantity),
                        axis.name, shown, axis.min_au, axis.max_au),
            "reference the axis; else correct node, scale or offset in the mapping: they must be "
            "those of the machine's own coordinates, in mm"));
      }
    }
  }
  return out;
}

std::optional<Refusal> motion_fault(const Reading& reading, const kernel::machine::OpcUa& config) {
  const double shown = reading[Quantity::motion_number];
  const bool wrong = shown < 1.0 || shown > static_cast<double>(kGroup1Codes);
  if (!wrong || std::isfinite(reading[Quantity::motion_g])) {
    return std::nullopt;
  }
  return bad_input(config.mapping,
                   fmt::format("{} is {:g} now; allowed: 1 … {}. The layer takes every motion for "
                               "a thread and changes no override",
                               word_of(Quantity::motion_number), shown, kGroup1Codes),
                   "name G group 1 in MD22510 (MD22512 for programs in ISO language); else correct "
                   "its node in the mapping");
}

}  // namespace steadyrest::adapters::opcua
