// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <steadyrest/adapters/opcua/reading.hpp>
#include <steadyrest/adapters/opcua/wire.hpp>
#include <steadyrest/kernel/machine/links/opcua.hpp>
#include <steadyrest/kernel/outcome/result.hpp>

namespace steadyrest::adapters::opcua {

/// Which nodes are read and written, each once, and where the quantities are in them.
class NodePlan {
 public:
  struct Node {
    std::string id;
    std::uint32_t length = 0;  ///< of the array; 0: a single value
    bool text = false;
  };

  explicit NodePlan(const kernel::machine::OpcUa& config);

  [[nodiscard]] const std::vector<Node>& reads() const noexcept { return reads_; }
  [[nodiscard]] const std::vector<Node>& writes() const noexcept { return writes_; }
  [[nodiscard]] bool reads(kernel::machine::Quantity quantity) const noexcept;
  [[nodiscard]] bool writes(kernel::machine::Quantity quantity) const noexcept;

  /// The quantities in one answer; what is missing, bad or of another type is NaN. Refused: an
  /// answer with another number of nodes.
  [[nodiscard]] kernel::outcome::Result<Reading> decode(const Answer& answer) const;
  /// Values for writes(), in order.
  [[nodiscard]] std::vector<std::vector<double>> encode(const Order& order) const;

 private:
  struct Slot {
    std::size_t node = 0;
    kernel::machine::OpcUaPlace place;
  };
  static std::size_t node_of(std::vector<Node>& nodes, const kernel::machine::OpcUaPlace& place);

  std::vector<Node> reads_;
  std::vector<Node> writes_;
  std::vector<Slot> read_slots_;
  std::vector<Slot> write_slots_;
};

}  // namespace steadyrest::adapters::opcua
