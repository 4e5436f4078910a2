// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::outcome::bad_input;
using kernel::outcome::Refusal;

constexpr std::array<std::string_view, 11> kNumeric = {"Boolean", "SByte", "Byte",   "Int16",
                                                       "UInt16",  "Int32", "UInt32", "Int64",
                                                       "UInt64",  "Float", "Double"};

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

std::vector<Refusal> value_faults(const Reading& reading, const kernel::machine::Machine& machine) {
  using kernel::machine::OverrideTable;
  using kernel::machine::Quantity;
  std::vector<Refusal> out;
  const auto check = [&](Quantity quantity, const std::string& of, double shown, double least,
                         double most) {
    if (shown < least || shown > most) {
      out.push_back(
          bad_input(machine.opcua.mapping,
                    fmt::format("{}{} is {:g} now; it can be {:g} … {:g}",
                                kernel::machine::kQuantityWords[static_cast<std::size_t>(quantity)],
                                of, shown, least, most),
                    "correct its node, scale or offset in the mapping"));
    }
  };
  const auto most_percent = [](const OverrideTable& table) {
    constexpr double kMost = 2.0;
    return 100.0 * (table.ratio.empty() ? kMost : std::max(kMost, table.ratio.back()));
  };
  const std::array<std::pair<Quantity, const OverrideTable*>, 6> overrides = {
      {{Quantity::feed_panel_percent, &machine.feed_override},
       {Quantity::feed_effective_percent, &machine.feed_override},
       {Quantity::rapid_panel_percent, &machine.rapid_override},
       {Quantity::rapid_effective_percent, &machine.rapid_override},
       {Quantity::spindle_panel_percent, &machine.spindle_override},
       {Quantity::spindle_effective_percent, &machine.spindle_override}}};
  for (const auto& [quantity, table] : overrides) {
    check(quantity, "", reading[quantity], 0.0, most_percent(*table));
  }
  constexpr double kBeyond_mm = 1.0;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto& axis = machine.axes[i];
    if (axis.present && !axis.rotary) {
      for (const Quantity quantity : {Quantity::command_mm, Quantity::actual_mm}) {
        check(quantity, " of " + axis.name, reading(quantity, i), axis.min_au - kBeyond_mm,
              axis.max_au + kBeyond_mm);
      }
    }
  }
  return out;
}

}  // namespace steadyrest::adapters::opcua
