// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace steadyrest::adapters::lines {

/// Two channels a quarter of a period apart, each edge counted (×4).
class Quadrature {
 public:
  enum class Channel : std::uint8_t { a, b };

  void start(bool a, bool b) noexcept {
    a_ = a;
    b_ = b;
  }
  /// What a channel's edge counts: +1 where A leads B, else −1; 0: the channel had that level
  /// already, so that an edge between is missing.
  [[nodiscard]] int edge(Channel channel, bool high) noexcept {
    bool& level = channel == Channel::a ? a_ : b_;
    if (level == high) {
      return 0;
    }
    level = high;
    const bool leads = channel == Channel::a ? a_ != b_ : a_ == b_;
    return leads ? 1 : -1;
  }

 private:
  bool a_ = false;
  bool b_ = false;
};

}  // namespace steadyrest::adapters::lines
