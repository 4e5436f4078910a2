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

}  // namespace steadyrest::adapters::opcua
