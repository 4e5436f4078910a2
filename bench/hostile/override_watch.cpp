// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <bench/hostile/override_watch.hpp>
#include <fmt/format.h>

// The machine's side, written a second time from the safety section of the design, so that a
// mistake of the layer's code cannot hide in the same code here.
namespace steadyrest::bench::hostile {

OverrideWatch::OverrideWatch(Rules rules) : rules_(std::move(rules)) {
  const auto& table = rules_.table;
  for (std::size_t i = 0; i < table.ratio.size(); ++i) {
    const auto position = static_cast<std::uint32_t>(i) + 1U;
    // A switch whose table gives no codes counts its positions from 1 in Gray code.
    const std::uint32_t code = table.code.empty() ? position ^ (position >> 1U) : table.code[i];
    if (by_code_.size() <= code) {
      by_code_.resize(code + 1U, std::numeric_limits<double>::quiet_NaN());
    }
    by_code_[code] = std::min(table.ratio[i], table.max_ratio);
    if (i > 0) {
      widest_ = std::max(widest_, by_code_[code] - std::min(table.ratio[i - 1], table.max_ratio));
    }
  }
}

double OverrideWatch::decode(std::uint32_t code) const {
  return code < by_code_.size() ? by_code_[code] : std::numeric_limits<double>::quiet_NaN();
}

/// The design's first rule: min(layer, panel), panel 0 stops.
double OverrideWatch::in_force(const Word& word) const {
  if (panel_ == 0.0 || !word.masks) {
    return panel_;
  }
  const double layer = decode(word.code);
  return rules_.table.layer_may_exceed_panel || std::isnan(layer) ? layer : std::min(layer, panel_);
}

double OverrideWatch::floor(double ratio) const {
  double below = std::min(rules_.table.ratio.front(), rules_.table.max_ratio);
  for (const double step : rules_.table.ratio) {
    below = step <= ratio + kTolerance ? std::min(step, rules_.table.max_ratio) : below;
  }
  return below;
}

/// A walk over all neighbours takes a scan each; twice that, plus the way at the slower of the two
/// rates.
double OverrideWatch::longest_way_s() const noexcept {
  const double walk_s =
      static_cast<double>(rules_.table.ratio.size() + 4) * rules_.table.scan_period_s;
  const double range = rules_.table.ratio.back() + 0.5;
  return 2.0 * walk_s + range / std::min(rules_.rise_1_s, rules_.fall_1_s);
}

/// Bounds on what may be in force widen with real time, by the permitted rates.
void OverrideWatch::pass(double real_s) {
  now_s_ += real_s;
  highest_ += rules_.rise_1_s * real_s;
  lowest_ -= rules_.fall_1_s * real_s;
  // A word replaced more than a scan ago can no longer be read.
  while (!past_.empty() && past_.front().until_s <=
                               now_s_ + rules_.slack_s - rules_.table.scan_period_s + kTolerance) {
    past_.pop_front();
  }
}

void OverrideWatch::drop() {
  word_.masks = false;
  past_.clear();
}

/// A word that is not latched may be read while its wires change: any mixture of the bits of old
/// and new words, with either mask. Each mixture must decode to a ratio between those of the words
/// involved.
std::string OverrideWatch::check_mixtures(const Word& word) {
  if (rules_.latched) {
    return {};
  }
  std::uint32_t differing = 0;
  bool some_mask = word.masks;
  bool all_mask = word.masks;
  double low = in_force(word);
  double high = low;
  for (const Past& past : past_) {
    differing |= past.word.code ^ word.code;
    some_mask = some_mask || past.word.masks;
    all_mask = all_mask && past.word.masks;
    low = std::min(low, in_force(past.word));
    high = std::max(high, in_force(past.word));
  }
  if (!some_mask) {
    return {};
  }
  // All subsets of the differing bits, by counting down through the mask.
  for (std::uint32_t part = differing;; part = (part - 1) & differing) {
    for (const bool mask : {true, all_mask}) {
      const double seen = in_force({.code = word.code ^ part, .masks = mask});
      if (!(seen >= low - kTolerance && seen <= high + kTolerance)) {
        return fmt::format(
            "mixture: the reader may see {:#b}, mask {}, = {:g}; the words of this "
            "scan are within {:g} … {:g}",
            word.code ^ part, mask, seen, low, high);
      }
    }
    if (part == 0) {
      return {};
    }
  }
}

/// A word is judged in the order of the design's rules: capability, table, panel, threads,
/// mixtures, slew.
std::string OverrideWatch::write(const Word& word, bool hold) {
  if (std::isnan(panel_)) {
    word_ = word;
    return word.masks ? "panel: masked before any panel was known" : std::string{};
  }
  const double layer = decode(word.code);
  if (word.masks && !rules_.available) {
    return "capability: the port has no such override";
  }
  if (word.masks && std::isnan(layer)) {
    return fmt::format("decodes: the table has no {:#b}", word.code);
  }
  if (word.masks &&
      (panel_ == 0.0 || (!rules_.table.layer_may_exceed_panel && layer > panel_ + kTolerance))) {
    return fmt::format("panel: masked at {:g}, panel {:g}", layer, panel_);
  }
  const double before = in_force();
  const double now = in_force(word);
  // In a thread the feed is tied to the spindle; a change would tear it.
  if (hold && std::abs(now - before) > kTolerance) {
    return fmt::format("hold: {:g} → {:g} in a thread, panel {:g}", before, now, panel_);
  }
  if (word.code != word_.code || word.masks != word_.masks) {
    past_.push_back({.word = word_, .until_s = now_s_});
    word_ = word;
  }
  if (std::string broken = check_mixtures(word); !broken.empty()) {
    return broken;
  }
  // One step of the table is always permitted: a ratio between two steps does not exist.
  const double step = widest_ + kTolerance;
  const double rise = step + rules_.rise_1_s * rules_.slack_s;
  const double fall = step + rules_.fall_1_s * rules_.slack_s;
  const double passed_s = now_s_ - std::exchange(written_s_, now_s_);
  // The operator's own change is allowed, so the bounds include it.
  highest_ = std::max(highest_, before + rise + rules_.rise_1_s * passed_s);
  lowest_ = std::min(lowest_, before - fall - rules_.fall_1_s * passed_s);
  if (now > highest_ || now < lowest_) {
    return fmt::format("slew: {:g} → {:g}, allowed {:g} … {:g}, panel {:g}", before, now, lowest_,
                       highest_, panel_);
  }
  highest_ = std::min(highest_, now + rise);
  lowest_ = std::max(lowest_, now - fall);
  return {};
}

}  // namespace steadyrest::bench::hostile
