// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <steadyrest/nc/interpret/parameters/sinumerik_variables.hpp>

// The system variables of sinumerik ("Job planning", "System variables").
namespace steadyrest::nc::interpret {

using read::Lookup;

// What the program itself may have set; `shown`: what must be known for it.
bool SinumerikVariables::of_state(std::string_view name, char axis, double& value,
                                  ModeMask& shown) const {
  const State& state = *state_;
  const auto is = [&](std::string_view wanted, ModeMask needed, double answer) {
    if (name != wanted || axis != 0) {
      return false;
    }
    value = answer;
    shown = needed;
    return true;
  };
  constexpr double kPerMinute = 60.0;
  const bool metric = state.unit_mm == 1.0 && state.feed_unit_mm == 1.0;
  const int motion = state.plain_motion;
  // Groups count their words from 1: G0 G1 G2 G3; G17 G18 G19; G90 G91.
  return is("$P_UIFRNUM", mode(GGroup::work_offset),
            state.work_offset_on ? static_cast<double>(state.active_offset + 1) : 0.0) ||
         (metric && state.feed_mode == FeedMode::per_minute &&
          is("$P_F", kFeedMode, state.feed_mm_s * kPerMinute)) ||
         (!state.surface_speed && is("$P_S", kSpeedMode, state.spindle_speed_rev_s * kPerMinute)) ||
         (motion >= g::kRapid && motion <= g::kArcCounterClockwise &&
          is("$P_GG[1]", mode(GGroup::motion), motion / 10.0 + 1.0)) ||
         is("$P_GG[6]", mode(GGroup::plane), static_cast<double>(state.plane) + 1.0) ||
         is("$P_GG[14]", mode(GGroup::distance), state.incremental ? 2.0 : 1.0);
}

Lookup SinumerikVariables::system(std::string_view name, char axis, double& value) const {
  constexpr std::array<std::string_view, 9> kKinds = {"$P_",  "$A",   "$V",   "$MC_", "$MA_",
                                                      "$MN_", "$SC_", "$SA_", "$TC_"};
  if (state_ == nullptr || std::ranges::none_of(kKinds, [&](std::string_view kind) {
        return name.size() > kind.size() && name.starts_with(kind);
      })) {
    return Lookup::not_known_here;
  }
  value = 0.0;
  const auto place = kAxisLetters.find(axis);
  if (name == "$P_EP") {
    if (axis == 0 || place == std::string_view::npos || state_->unit_mm != 1.0) {
      return Lookup::not_known_here;
    }
    value = state_->position.at(place);
    asked_.about_position(place);
    if (known_ != nullptr && (known_->axes >> place & 1U) == 0) {
      known_->hear("$P_EP[" + std::string(1, axis) + "]", value);
    }
    return Lookup::found;
  }
  ModeMask shown = 0;
  std::string written{name};
  if (axis != 0) {
    written.append("[").append(1, axis).append("]");
  }
  if (of_state(name, axis, value, shown)) {
    asked_.about_mode(shown);
    if (known_ != nullptr && (shown & ~known_->modes) != 0) {
      known_->hear(std::move(written), value);
    }
    return Lookup::found;
  }
  asked_.about(written);
  if (known_ != nullptr) {
    known_->hear(std::move(written), value);
  }
  return Lookup::found;
}

}  // namespace steadyrest::nc::interpret
