// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/adapters/opcua/node_plan.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::adapters::opcua {
namespace {

using kernel::machine::OpcUaPlace;
using kernel::machine::Quantity;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

double shown_at(const Answer::Value& value, const OpcUaPlace& place) noexcept {
  if (value.status != 0 || (place.length == 0 && value.numbers.size() != 1)) {
    return kNotKnown;
  }
  return place.index < value.numbers.size()
             ? place.scale * value.numbers[place.index] + place.offset
             : kNotKnown;
}

double wanted(const Order& order, const OpcUaPlace& place) noexcept {
  switch (place.quantity) {
    case Quantity::heartbeat:
    case Quantity::heartbeat_copy:
      return order.heartbeat;
    case Quantity::masks_feed:
      return order.masks_feed ? 1.0 : 0.0;
    case Quantity::masks_spindle:
      return order.masks_spindle ? 1.0 : 0.0;
    case Quantity::has_offsets:
      return order.has_offsets ? 1.0 : 0.0;
    case Quantity::feed_percent:
      return order.masks_feed ? order.feed_percent : 100.0;
    case Quantity::spindle_percent:
      return order.masks_spindle ? order.spindle_percent : 100.0;
    case Quantity::axis_offset_mm:
      return order.has_offsets ? order.offset_mm[place.axis] : 0.0;
    case Quantity::heartbeat_byte:
      return heartbeat_byte(order.heartbeat);
    case Quantity::mask_byte:
      return (order.masks_feed ? 1.0 : 0.0) + (order.masks_spindle ? 2.0 : 0.0);
    case Quantity::feed_position:
      return order.feed_position;
    case Quantity::spindle_position:
      return order.spindle_position;
    default:
      return 0.0;
  }
}

}  // namespace

std::size_t NodePlan::node_of(std::vector<Node>& nodes, const OpcUaPlace& place) {
  const auto found = std::ranges::find(nodes, place.node, &Node::id);
  if (found != nodes.end()) {
    found->length = std::max(found->length, place.length);
    return static_cast<std::size_t>(found - nodes.begin());
  }
  nodes.push_back(
      {.id = place.node, .length = place.length, .text = place.quantity == Quantity::program_name});
  return nodes.size() - 1;
}

NodePlan::NodePlan(const kernel::machine::OpcUa& config) {
  for (const OpcUaPlace& place : config.reads) {
    read_slots_.push_back({node_of(reads_, place), place});
  }
  for (const OpcUaPlace& place : config.writes) {
    write_slots_.push_back({node_of(writes_, place), place});
  }
}

bool NodePlan::reads(Quantity quantity) const noexcept {
  return std::ranges::any_of(read_slots_,
                             [=](const Slot& slot) { return slot.place.quantity == quantity; });
}

bool NodePlan::writes(Quantity quantity) const noexcept {
  return std::ranges::any_of(write_slots_,
                             [=](const Slot& slot) { return slot.place.quantity == quantity; });
}

kernel::outcome::Result<Reading> NodePlan::decode(const Answer& answer) const {
  if (answer.values.size() != reads_.size()) {
    return kernel::outcome::unavailable("the OPC UA bridge answered for other nodes than asked",
                                        "use the bridge that belongs to this program");
  }
  Reading out;
  for (const Slot& slot : read_slots_) {
    const Answer::Value& value = answer.values[slot.node];
    if (slot.place.quantity == Quantity::program_name) {
      const std::size_t size = std::min(value.text.size(), kLongestName);
      std::copy_n(value.text.begin(), value.status == 0 ? size : 0, out.program.begin());
      continue;
    }
    const double shown = shown_at(value, slot.place);
    if (kernel::machine::is_of_axis(slot.place.quantity)) {
      out.axis[slot.place.axis][Reading::index_of(slot.place.quantity)] = shown;
    } else {
      out.value[static_cast<std::size_t>(slot.place.quantity)] = shown;
    }
  }
  if (!answer.values.empty() && answer.values.front().time_s > 0.0) {
    out.source_s = answer.values.front().time_s;
  }
  return out;
}

std::vector<std::vector<double>> NodePlan::encode(const Order& order) const {
  std::vector<std::vector<double>> out;
  out.reserve(writes_.size());
  for (const Node& node : writes_) {
    out.emplace_back(std::max<std::uint32_t>(1, node.length), 0.0);
  }
  for (const Slot& slot : write_slots_) {
    const double value = (wanted(order, slot.place) - slot.place.offset) / slot.place.scale;
    if (slot.place.index < out[slot.node].size()) {
      out[slot.node][slot.place.index] = std::isfinite(value) ? value : 0.0;
    }
  }
  return out;
}

}  // namespace steadyrest::adapters::opcua
