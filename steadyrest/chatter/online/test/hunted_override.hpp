// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include <steadyrest/kernel/override/channel.hpp>

/// One override of the hunted machine: envelope, hand-over, and the control that reads the word
/// once per scan and acts a dead time later.
namespace steadyrest::chatter::online::test {

class HuntedOverride {
 public:
  using Channel = kernel::override::Channel;

  struct Seen {
    bool invalid = false;           ///< the code matches no step
    std::uint32_t code = 0;         ///< that code
    std::optional<double> outside;  ///< a mixture of two words decoded to this
    bool changed = false;           ///< a masked word changed
  };

  HuntedOverride(const Channel::Config& config, bool walked)
      : channel_(Channel::make(config).value()),
        walked_(walked),
        scan_s_(config.table.scan_period_s),
        dead_s_(config.table.dead_time_s) {}

  [[nodiscard]] const kernel::override::Table& table() const noexcept { return channel_.table(); }
  /// The envelope's output.
  [[nodiscard]] kernel::signal::RatioInForce told() const noexcept { return channel_.in_force(); }
  /// The ratio in force at this time; time never goes back.
  double in_force(double time_s) {
    while (!coming_.empty() && coming_.front().first <= time_s) {
      in_force_ = coming_.front().second;
      coming_.pop_front();
    }
    return in_force_;
  }

  template <class Request>
  Seen drive(double time_s, const Request& request, const kernel::signal::OverrideState& panel,
             kernel::outcome::Reason unfit, bool hold) {
    Seen seen;
    const auto out = channel_.update({.step_s = time_s - std::exchange(driven_s_, time_s),
                                      .ratio = hold ? 1.0 : request.ratio,
                                      .reason = request.reason,
                                      .panel = panel,
                                      .unfit = unfit,
                                      .hold = hold});
    const auto step = table().step_of_code(out.code);
    if (!step) {
      seen.invalid = true;
      seen.code = out.code;
      return seen;
    }
    const Word now{.code = out.code, .masks = out.masks_panel, .known = true};
    const double ratio = decoded(table().ratio(*step), now.masks, panel);
    if (word_.known && walked_ && panel.panel_code_known) {
      check_mixtures(now, ratio, panel, seen);
    }
    seen.changed = word_.masks && now.masks && word_.code != now.code;
    word_ = now;
    pass_on(time_s, ratio);
    return seen;
  }

 private:
  struct Word {
    std::uint32_t code = 0;
    bool masks = false;
    bool known = false;
  };

  [[nodiscard]] double decoded(double ratio, bool masks,
                               const kernel::signal::OverrideState& panel) const {
    const bool counts = masks && panel.panel_ratio > 0.0;
    return !counts                            ? panel.panel_ratio
           : table().layer_may_exceed_panel() ? ratio
                                              : std::min(ratio, panel.panel_ratio);
  }

  /// Wires change one after the other: anything read meanwhile must lie between the two.
  void check_mixtures(const Word& now, double to, const kernel::signal::OverrideState& panel,
                      Seen& seen) const {
    const auto from_step = table().step_of_code(word_.code);
    const double from = decoded(from_step ? table().ratio(*from_step) : 0.0, word_.masks, panel);
    const auto [low, high] = std::minmax(from, to);
    const std::uint32_t differing = word_.code ^ now.code;
    for (std::uint32_t part = differing;; part = (part - 1) & differing) {
      const auto step = table().step_of_code(word_.code ^ part);
      for (const bool masks : {word_.masks, now.masks}) {
        const double ratio = step    ? decoded(table().ratio(*step), masks, panel)
                             : masks ? -1.0
                                     : panel.panel_ratio;
        if (ratio < low - 1e-9 || ratio > high + 1e-9) {
          seen.outside = ratio;
        }
      }
      if (part == 0) {
        break;
      }
    }
  }

  void pass_on(double time_s, double ratio) {
    if (coming_.empty() ? ratio != in_force_ : ratio != coming_.back().second) {
      coming_.emplace_back((std::floor(time_s / scan_s_) + 1.0) * scan_s_ + dead_s_, ratio);
    }
  }

  double driven_s_ = 0.0;
  Channel channel_;
  bool walked_;
  double scan_s_;
  double dead_s_;
  Word word_;
  double in_force_ = 1.0;
  std::deque<std::pair<double, double>> coming_;  ///< when, ratio
};

}  // namespace steadyrest::chatter::online::test
