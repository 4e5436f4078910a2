// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include <steadyrest/sim/base/range.hpp>
#include <steadyrest/sim/panel/override_input.hpp>

// The override as a PLC handles it: it scans at its own pace, reads the panel's and the layer's
// words at the scan, and the decision takes effect one dead time later. Heartbeat and mask are
// judged here, on the machine's side, so that a dead layer loses its mask whatever it wrote last.
namespace steadyrest::sim {
namespace {

constexpr double kTimeTolerance = 1e-9;  ///< a scan due to within rounding is due
constexpr double kMaxPending = 1e6;

}  // namespace

kernel::outcome::Result<OverrideInput> OverrideInput::make(const Config& config) {
  auto table = kernel::override::Table::make(config.table);
  if (!table) {
    return std::unexpected(table.error());
  }
  if (auto ok = in_range("override input", {{"period_s", config.period_s, 1e-6, 1.0},
                                            {"watchdog_s", config.watchdog_s, 1e-3, 1e6},
                                            {"hand_back_rise_1_s", config.hand_back_rise_1_s, 1e-6,
                                             kernel::machine::kUnlimited}});
      !ok) {
    return std::unexpected(ok.error());
  }
  // Two more than can be under way at once: one just in, one just out.
  const double scan_s = std::max(config.period_s, table->scan_period_s());
  const double pending = std::ceil(table->dead_time_s() / scan_s) + 2.0;
  if (pending > kMaxPending) {
    return std::unexpected(refusal("override table: dead_time is more than a million scans"));
  }
  return OverrideInput(config, *std::move(table), static_cast<std::size_t>(pending));
}

OverrideInput::OverrideInput(const Config& config, kernel::override::Table table,
                             std::size_t capacity)
    : table_(std::move(table)),
      // No scan can be faster than the machine's simulation.
      scan_s_(std::max(config.period_s, table_.scan_period_s())),
      dead_s_(table_.dead_time_s()),
      watchdog_s_(config.watchdog_s),
      rise_(config.hand_back_rise_1_s * scan_s_),
      ring_(capacity) {}

std::uint32_t OverrideInput::home_code() const noexcept {
  return table_.code(table_.nearest_step(1.0).value_or(0));
}

void OverrideInput::read_panel(const Input& input) noexcept {
  state_.panel_code = input.panel_code;
  const auto step = table_.step_of_code(input.panel_code);
  state_.panel_code_known = step.has_value();
  if (step) {
    state_.panel_ratio = table_.ratio(*step);
  }
}

/// Takes the layer's word as the wires show it at this scan.
void OverrideInput::read_layer(const Input& input) noexcept {
  const std::uint32_t changing = seen_word_ ^ input.layer_code;
  // The lowest bit that changes.
  const std::uint32_t lowest = changing & (~changing + 1U);
  const bool race = !table_.latched_word() && input.layer_masks && masked_ && changing != lowest;
  // Several bits change on the wires at once: one scan sees only the first of them, the next the
  // whole word. Walking protects against this.
  seen_word_ = race && !racing_ ? seen_word_ ^ lowest : input.layer_code;
  racing_ = race && !racing_;
}

// Order of precedence: the operator's 0, the layer's mask while it is alive and its word is known,
// the panel.
double OverrideInput::decide(const Input& input) noexcept {
  const bool alive = heartbeat_ != 0 && input.time_s - heartbeat_time_s_ <= watchdog_s_;
  const auto step = table_.step_of_code(seen_word_);
  const bool was_masked = masked_;
  masked_ = input.layer_masks && alive && step.has_value();
  const double panel = state_.panel_ratio;
  // The operator's 0 stops, whatever the layer asks.
  if (panel <= 0.0) {
    handing_back_ = false;
    return 0.0;
  }
  if (masked_) {
    handing_back_ = false;
    const double layer = table_.ratio(*step);
    return table_.layer_may_exceed_panel() ? layer : std::min(layer, panel);
  }
  // When the mask drops, the value rises to the panel's by a ramp, but falls to it at once.
  handing_back_ = (handing_back_ || was_masked) && decided_ + rise_ < panel;
  return handing_back_ ? decided_ + rise_ : panel;
}

void OverrideInput::scan(const Input& input) noexcept {
  read_panel(input);
  read_layer(input);
  decided_ = decide(input);
  if (!started_) {
    started_ = true;
    state_.effective_ratio = decided_;
  }
  // A ring for the dead time: what is decided now acts later, in order.
  const std::size_t slot = (head_ + count_) % ring_.size();
  ring_[slot] = {.time_s = input.time_s + dead_s_, .ratio = decided_};
  count_ = std::min(count_ + 1, ring_.size());
}

kernel::signal::OverrideState OverrideInput::update(const Input& input) noexcept {
  if (input.heartbeat != heartbeat_) {
    heartbeat_ = input.heartbeat;
    heartbeat_time_s_ = input.time_s;
  }
  // Scans are numbered: summing up periods would drift against the machine's time.
  const double number = std::floor(input.time_s / scan_s_ + kTimeTolerance);
  if (number > scanned_) {
    scanned_ = number;
    scan(input);
  }
  while (count_ > 0 && ring_[head_].time_s <= input.time_s + kTimeTolerance) {
    state_.effective_ratio = ring_[head_].ratio;
    head_ = (head_ + 1) % ring_.size();
    --count_;
  }
  return state_;
}

}  // namespace steadyrest::sim
