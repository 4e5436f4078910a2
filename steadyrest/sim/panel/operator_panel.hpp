// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace steadyrest::sim {

/// What an operator does at the panel.
enum class OperatorAct : std::uint8_t {
  turn_feed,     ///< `code` becomes the feed switch's word
  turn_rapid,    ///< likewise the rapid switch
  turn_spindle,  ///< likewise the spindle switch
  feed_hold,     ///< feed and rapid stop
  feed_start     ///< and resume
};

struct OperatorAction {
  double time_s = 0.0;
  OperatorAct act = OperatorAct::feed_hold;
  std::uint32_t code = 0;  ///< raw word, in the table or not
};

/// The simulated machine's panel, moved by a script: the last action up to a time applies.
class OperatorPanel {
 public:
  struct State {
    std::uint32_t feed_code = 0;
    std::uint32_t rapid_code = 0;
    std::uint32_t spindle_code = 0;
    bool feed_hold = false;
  };

  /// Actions may come in any order; simultaneous ones act in the order given.
  OperatorPanel(const State& start, const std::vector<OperatorAction>& actions);

  const State& update(double time_s) noexcept;

 private:
  State state_;
  std::vector<OperatorAction> actions_;
  std::size_t next_ = 0;
};

}  // namespace steadyrest::sim
