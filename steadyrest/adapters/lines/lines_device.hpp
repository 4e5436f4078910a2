// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <steadyrest/adapters/lines/encoders/encoder_source.hpp>
#include <steadyrest/adapters/lines/override_line.hpp>
#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/kernel/link/exchange.hpp>
#include <steadyrest/kernel/machine/links/lines.hpp>

namespace steadyrest::adapters::lines {

/// One reading of everything.
struct LineSample {
  Levels inputs;
  OverrideLine::Seen feed;  ///< of what is wired
  OverrideLine::Seen spindle;
  EncoderReading encoders;
  bool in_thread = false;       ///< by `locked`, and `locked_hold_ms` longer
  bool positions_known = true;  ///< false: the encoders have failed, the layer's word is in force
  double read_s = 0.0;          ///< monotonic clock
};

/// What the layer wants of both overrides.
struct LineOrder {
  Word feed;
  Word spindle;
};

/// Lines and encoders together, in the exchange's thread.
///
/// The layer acts from its first order on. When no order has come for three readings it does not
/// act any more: the masks are taken off. While it does not act nothing is written, but for the
/// wiring `through`, which needs the panel's word passed on. Outputs that are not as they were
/// written in two readings one after the other are a fault of the link: the module's watchdog has
/// dropped them, a line is stuck, or another client writes. Three such faults, each within a minute
/// of the one before, and the layer lets go for good: two that write would flip the word for ever.
/// While another one's heartbeat beats it does not begin to act. Where its last write is older than
/// the machine keeps it (`holds_s`) it begins without masks, whatever the module has kept.
class LinesDevice final : public kernel::link::Device<LineSample, LineOrder> {
 public:
  struct Parts {
    std::unique_ptr<Wires> wires;
    std::unique_ptr<EncoderSource> encoders;  ///< null: none
    std::optional<OverrideLine> feed;         ///< empty: not wired
    std::optional<OverrideLine> spindle;
    double holds_s = 0.1;     ///< the machine keeps what was written for so long
    bool only_looks = false;  ///< nothing is written, whatever the wiring
  };

  LinesDevice(const kernel::machine::Lines& lines, Parts parts);
  /// Takes the masks off.
  ~LinesDevice() override;

  kernel::outcome::Result<void> read(LineSample& sample) override;
  kernel::outcome::Result<void> write(const LineOrder& order) override;

 private:
  kernel::outcome::Result<void> read_lines(LineSample& sample);
  kernel::outcome::Result<void> check_outputs(const Levels& outputs);
  kernel::outcome::Result<void> dispute(const Levels& outputs, const Levels& differ);
  kernel::outcome::Result<void> pass_on();
  kernel::outcome::Result<void> send(const Levels& outputs);
  void release(Levels& outputs) noexcept;
  void adopt(const Levels& outputs) noexcept;
  [[nodiscard]] bool in_thread(const Levels& inputs) noexcept;
  [[nodiscard]] bool is_old() const noexcept;
  [[nodiscard]] bool settled(const OverrideLine& line) const noexcept;

  kernel::machine::Lines lines_;
  Parts parts_;
  Levels ours_;   ///< outputs that the layer sets
  Levels words_;  ///< of them without the heartbeat
  Levels masks_;
  Levels on_wires_;
  std::uint64_t connection_ = 0;
  bool sent_ = false;  ///< `on_wires_` is what was written on this connection
  bool acting_ = false;
  int silent_ = 0;           ///< readings since the last order
  int differing_ = 0;        ///< readings with other outputs
  bool taken_ = false;       ///< a reading has shown outputs as they were written
  bool adopted_ = false;     ///< `on_wires_` is what a reading has shown
  double written_s_ = -1e9;  ///< the last write that was taken
  double silence_s_ = 0.0;   ///< since then, when outputs began to differ
  double locked_s_ = -1e9;   ///< `locked` was seen last
  double ran_s_ = -1e9;      ///< a program was seen to run
  double beaten_s_ = -1e9;   ///< when the heartbeat changed and nobody here had written it
  double fastest_s_ = 1e9;   ///< a write takes at least
  double since_s_ = 0;       ///< when the words on the wires were written
  int disputes_ = 0;         ///< lost links by other outputs
  double dispute_s_ = 0;     ///< the last one
  std::optional<kernel::outcome::Refusal> let_go_;  ///< why the layer does not act any more
};

}  // namespace steadyrest::adapters::lines
