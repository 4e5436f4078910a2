// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/sim/panel/operator_panel.hpp>

// A scripted operator, so that a run with people in it is repeatable.
namespace steadyrest::sim {

OperatorPanel::OperatorPanel(const State& start, const std::vector<OperatorAction>& actions)
    : state_(start) {
  // Insertion keeps equal times in order; std::stable_sort of this library is deprecated in C++23.
  for (const OperatorAction& action : actions) {
    actions_.insert(std::ranges::upper_bound(actions_, action.time_s, {}, &OperatorAction::time_s),
                    action);
  }
}

const OperatorPanel::State& OperatorPanel::update(double time_s) noexcept {
  for (; next_ < actions_.size() && actions_[next_].time_s <= time_s; ++next_) {
    const OperatorAction& action = actions_[next_];
    switch (action.act) {
      case OperatorAct::turn_feed:
        state_.feed_code = action.code;
        break;
      case OperatorAct::turn_rapid:
        state_.rapid_code = action.code;
        break;
      case OperatorAct::turn_spindle:
        state_.spindle_code = action.code;
        break;
      case OperatorAct::feed_hold:
        state_.feed_hold = true;
        break;
      case OperatorAct::feed_start:
        state_.feed_hold = false;
        break;
    }
  }
  return state_;
}

}  // namespace steadyrest::sim
