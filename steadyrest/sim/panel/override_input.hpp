// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/kernel/signal/frame.hpp>

namespace steadyrest::sim {

/// The machine's side of one override: the PLC that reads switch and layer, and its delays.
///
/// Law. At each scan (every `scan_period_s`) the PLC reads both words:
///   panel   ratio of its code; a code that is not in the table leaves the last known ratio
///   layer   counts while it masks, its heartbeat runs and its code is known; otherwise the panel
///           applies. layer_may_exceed_panel: its ratio as it is, else min(layer, panel).
///   panel 0 stops, whatever the layer says.
/// The scan's decision acts `dead_time_s` later. When the mask drops (handed back, heartbeat lost,
/// code unknown) the value returns to the panel's: upwards at most at `hand_back_rise_1_s`, never
/// in a jump; downwards at once.
/// A word that is not latched is read while it changes: the first scan after a change of several
/// bits sees only the lowest of them changed, the next the whole word. Walking Gray neighbours
/// protects against this hazard.
/// The watchdog: no new heartbeat for `watchdog_s` drops the mask until the next one.
class OverrideInput {
 public:
  struct Config {
    kernel::machine::OverrideTable table;
    double period_s = 0.001;  ///< between calls of update, > 0
    double watchdog_s = 0.1;
    double hand_back_rise_1_s = 2.0;
  };
  struct Input {
    double time_s = 0.0;
    std::uint32_t panel_code = 0;
    std::uint32_t layer_code = 0;
    bool layer_masks = false;
    std::uint64_t heartbeat = 0;
  };

  static kernel::outcome::Result<OverrideInput> make(const Config& config);

  kernel::signal::OverrideState update(const Input& input) noexcept;

  [[nodiscard]] const kernel::override::Table& table() const noexcept { return table_; }
  /// The code of the step nearest to 100 %: the panel's position when the machine is switched on.
  [[nodiscard]] std::uint32_t home_code() const noexcept;

 private:
  struct Pending {
    double time_s = 0.0;
    double ratio = 0.0;
  };

  OverrideInput(const Config& config, kernel::override::Table table, std::size_t capacity);
  void scan(const Input& input) noexcept;
  void read_layer(const Input& input) noexcept;
  void read_panel(const Input& input) noexcept;
  [[nodiscard]] double decide(const Input& input) noexcept;

  kernel::override::Table table_;
  double scan_s_;
  double dead_s_;
  double watchdog_s_;
  double rise_;  ///< per scan
  std::vector<Pending> ring_;
  std::size_t head_ = 0;
  std::size_t count_ = 0;
  double scanned_ = -1.0;  ///< number of the last scan
  std::uint32_t seen_word_ = 0;
  bool started_ = false;
  bool racing_ = false;
  bool masked_ = false;
  bool handing_back_ = false;
  double decided_ = 0.0;
  std::uint64_t heartbeat_ = 0;
  double heartbeat_time_s_ = 0.0;
  kernel::signal::OverrideState state_;
};

}  // namespace steadyrest::sim
