// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <tests/ports/subject.hpp>

#include <steadyrest/adapters/lines/lines_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/override/table.hpp>

namespace steadyrest::ports {

/// A machine behind override lines with a PLC that takes the lower word: cuts along X, 4 ms for
/// each reading. Wires and recorder are two halves of it, both used by the exchange's thread alone.
class LinesMill {
 public:
  static constexpr double kPeriod_s = 0.004;

  LinesMill(const kernel::machine::Machine& machine, std::vector<Turn> turns)
      : machine_(machine),
        table_(kernel::override::Table::make(machine.feed_override).value()),
        spindle_table_(kernel::override::Table::make(machine.spindle_override).value()),
        turns_(std::move(turns)) {}

  [[nodiscard]] static Subject subject(const kernel::machine::Machine& machine,
                                       const std::vector<Turn>& turns);

  std::atomic<bool> lost{false};

 private:
  using Levels = adapters::lines::Levels;
  static constexpr double kFeed_mm_s = 20.0;
  static constexpr std::uint32_t kClock_hz = 1'000'000;

  class Wires final : public adapters::lines::Wires {
   public:
    explicit Wires(std::shared_ptr<LinesMill> mill) : mill_(std::move(mill)) {}
    kernel::outcome::Result<void> read(Levels& inputs, Levels& outputs) override {
      if (mill_->lost.load()) {
        return kernel::outcome::unavailable("the link is cut", "mend it");
      }
      mill_->step();
      inputs = mill_->inputs_;
      outputs = mill_->outputs_;
      return {};
    }
    kernel::outcome::Result<void> write(const Levels& outputs) override {
      mill_->outputs_ = outputs;
      return {};
    }
    [[nodiscard]] std::uint64_t connections() const noexcept override { return 1; }
    [[nodiscard]] double now_s() const noexcept override { return mill_->time_s_; }

   private:
    std::shared_ptr<LinesMill> mill_;
  };

  class Encoders final : public adapters::lines::EncoderSource {
   public:
    explicit Encoders(std::shared_ptr<LinesMill> mill) : mill_(std::move(mill)) {}
    kernel::outcome::Result<adapters::lines::EncoderReading> next() override {
      return track_.take(mill_->sample());
    }

   private:
    std::shared_ptr<LinesMill> mill_;
    adapters::lines::RecorderTrack track_;
  };

  void step() {
    time_s_ += kPeriod_s;
    for (const Turn& turn : turns_) {
      panel_ = turn.time_s <= time_s_ ? turn.ratio : panel_;
    }
    const auto& wires = machine_.lines.feed;
    adapters::lines::put_word(table_.code(table_.nearest_step(panel_).value()), wires.panel, false,
                              inputs_);
    adapters::lines::put_word(spindle_table_.code(spindle_table_.nearest_step(1.0).value()),
                              machine_.lines.spindle.panel, false, inputs_);
    inputs_[machine_.lines.running] = true;
    const auto word = table_.step_of_code(adapters::lines::word_of(outputs_, wires.out, false));
    const double ratio =
        outputs_[wires.mask] && word ? std::min(panel_, table_.ratio(*word)) : panel_;
    x_mm_ += kFeed_mm_s * ratio * kPeriod_s;
  }
  [[nodiscard]] adapters::lines::RecorderSample sample() {
    adapters::lines::RecorderSample out{
        .sequence = ++sequence_,
        .ticks = static_cast<std::uint32_t>(std::llround(time_s_ * kClock_hz)),
        .clock_hz = kClock_hz,
        .counters = 3};
    out.counter[0].count =
        static_cast<std::int32_t>(std::floor(x_mm_ / machine_.axes[0].encoder.count_au));
    return out;
  }

  std::uint16_t sequence_ = 0;
  kernel::machine::Machine machine_;
  kernel::override::Table table_;
  kernel::override::Table spindle_table_;
  std::vector<Turn> turns_;
  Levels inputs_;
  Levels outputs_;
  double time_s_ = 0.0;
  double panel_ = 1.0;
  double x_mm_ = 0.0;
};

inline Subject LinesMill::subject(const kernel::machine::Machine& machine,
                                  const std::vector<Turn>& turns) {
  Subject subject;
  subject.machine = machine;
  const auto mill = std::make_shared<LinesMill>(machine, turns);
  subject.port = adapters::lines::LinesPort::make(machine, std::make_unique<Wires>(mill),
                                                  std::make_unique<Encoders>(mill))
                     .value();
  // Written after one reading, on the wires in the next.
  subject.in_force_s = 4.0 * kPeriod_s;
  subject.cut_link = [mill] { mill->lost.store(true); };
  subject.mend_link = [mill] { mill->lost.store(false); };
  return subject;
}

}  // namespace steadyrest::ports
