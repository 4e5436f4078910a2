// SPDX-License-Identifier: Apache-2.0
// A million messages of a module and a recorder that lie: no word outside of the table goes out, no
// position comes in that is none, and the loop goes on.
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <tests/lines/line_chain.hpp>

#include <steadyrest/adapters/lines/lines_device.hpp>
#include <steadyrest/adapters/lines/lines_port.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>

namespace steadyrest::test::lines {
namespace {

using adapters::lines::EncoderReading;
using adapters::lines::EncoderSource;
using adapters::lines::Levels;
using adapters::lines::LineOrder;
using adapters::lines::LineSample;
using adapters::lines::LinesDevice;
using adapters::lines::OverrideLine;
using adapters::lines::RecorderParser;
using adapters::lines::RecorderSample;
using adapters::lines::RecorderTrack;
using kernel::machine::Machine;
using kernel::outcome::Result;
using Dice = std::mt19937;

/// Any panel, any outputs read back, no answer, a new connection.
class LyingWires final : public adapters::lines::Wires {
 public:
  /// `beats`: it lies about the heartbeat too, as if another layer acted.
  LyingWires(const Machine& machine, unsigned seed, bool beats)
      : dice_(seed),
        beats_(beats),
        lines_(machine.lines),
        table_(kernel::override::Table::make(machine.feed_override).value()) {}

  Result<void> read(Levels& inputs, Levels& outputs) override {
    honest_ = false;
    now_s_ += 0.02;
    if (dice_() % 50 == 0) {
      ++connections_;
      return kernel::outcome::unavailable("no answer", "ask again");
    }
    inputs = Levels(dice_());
    if (dice_() % 2 == 0) {
      const auto step = dice_() % table_.steps();
      adapters::lines::put_word(table_.code(step), lines_.feed.panel, false, inputs);
    }
    honest_ = dice_() % 3 != 0;
    outputs = honest_ ? written_ : Levels(dice_());
    if (!beats_) {
      outputs[lines_.heartbeat] = written_[lines_.heartbeat];
    }
    return {};
  }
  Result<void> write(const Levels& outputs) override {
    ++tries_;
    if (dice_() % 100 == 0) {
      return kernel::outcome::unavailable("no answer", "ask again");
    }
    written_ = outputs;
    ++writes_;
    const auto code = adapters::lines::word_of(outputs, lines_.feed.out, false);
    wrong_ += outputs[lines_.feed.mask] && !table_.step_of_code(code) ? 1 : 0;
    return {};
  }
  [[nodiscard]] std::uint64_t connections() const noexcept override { return connections_; }
  [[nodiscard]] double now_s() const noexcept override { return now_s_; }

  [[nodiscard]] int wrong() const { return wrong_; }
  [[nodiscard]] int writes() const { return writes_; }
  [[nodiscard]] int tries() const { return tries_; }
  /// The last reading showed the outputs as they were written.
  [[nodiscard]] bool honest() const { return honest_; }

 private:
  Dice dice_;
  bool beats_;
  kernel::machine::Lines lines_;
  kernel::override::Table table_;
  Levels written_;
  std::uint64_t connections_ = 1;
  int wrong_ = 0;
  int writes_ = 0;
  int tries_ = 0;
  bool honest_ = false;
  double now_s_ = 0.0;
};

bool has_let_go(const kernel::outcome::Refusal& refusal) {
  return refusal.what.find("has let go of the outputs") != std::string::npos;
}

bool acts_beside(const Result<void>& written) {
  return !written && written.error().what.find("another one acts") != std::string::npos;
}

/// The module stays while one layer after the other is started on it.
class OfAll final : public adapters::lines::Wires {
 public:
  explicit OfAll(LyingWires& module) : module_(module) {}
  Result<void> read(Levels& inputs, Levels& outputs) override {
    return module_.read(inputs, outputs);
  }
  Result<void> write(const Levels& outputs) override { return module_.write(outputs); }
  [[nodiscard]] std::uint64_t connections() const noexcept override {
    return module_.connections();
  }
  [[nodiscard]] double now_s() const noexcept override { return module_.now_s(); }

 private:
  LyingWires& module_;
};

TEST(HostileLines, AMillionReadingsBringNoWordOutsideOfTheTable) {
  using kernel::machine::Wiring;
  for (const auto& [wiring, beats] :
       {std::pair(Wiring::plc, false), std::pair(Wiring::relay, false),
        std::pair(Wiring::plc, true)}) {
    Machine machine = wired_840d(0.040);
    machine.feed_override.latched_word = false;
    machine.lines.wiring = wiring;
    LyingWires module(machine, 5, beats);
    const auto begin = [&] {
      LinesDevice::Parts parts;
      parts.wires = std::make_unique<OfAll>(module);
      parts.feed =
          OverrideLine::make(
              {.wires = machine.lines.feed, .table = machine.feed_override, .wiring = wiring})
              .value();
      return std::make_unique<LinesDevice>(machine.lines, std::move(parts));
    };
    auto device = begin();
    Dice dice(6);
    LineSample sample;
    int let_go = 0;
    for (int i = 0; i < 500000; ++i) {
      if (const auto read = device->read(sample); !read && has_let_go(read.error())) {
        ++let_go;
        device = begin();
      }
      if (dice() % 4 != 0) {
        const int before = module.tries();
        const auto written = device->write(
            {.feed = {.code = static_cast<std::uint32_t>(dice() % 64), .masks = dice() % 2 == 0},
             .spindle = {}});
        // After a reading that differs nothing may be written, and nothing is begun beside another
        // layer; else the order goes out.
        ASSERT_TRUE(!module.honest() || module.tries() == before + 1 || acts_beside(written))
            << "reading " << i;
      }
    }
    EXPECT_EQ(module.wrong(), 0);
    if (beats) {
      continue;
    }
    EXPECT_GT(let_go, 1000) << "a module that lies for good is let go of, and started on again";
    // Three readings of four have an order, and at least two of three of those before it show the
    // outputs as they were written, so that it goes out; 3 % of all calls fail.
    EXPECT_GT(module.writes(), 0.97 * 500000 * 3 / 4 * 2 / 3);
  }
}

TEST(HostileLines, AMillionRecorderMessagesBringNoPositionThatIsNone) {
  Dice dice(8);
  RecorderParser parser;
  RecorderTrack track;
  RecorderSample truth{.clock_hz = 1'000'000, .counters = 3};
  RecorderSample got;
  int refused = 0;
  int taken = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    ++truth.sequence;
    truth.ticks += 1000;
    truth.counter[0].count += static_cast<std::int32_t>(dice() % 100);
    auto bytes = adapters::lines::message_of(truth);
    if (dice() % 2 == 0) {
      const std::size_t at = dice() % bytes.size();
      bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1U << dice() % 8U));
    }
    if (!parser.feed(bytes, got)) {
      ++refused;
      continue;
    }
    ++taken;
    ASSERT_EQ(got.counter[0].count, truth.counter[0].count) << "what counts is what was sent";
    ASSERT_EQ(got.ticks, truth.ticks);
    const auto reading = track.take(got);
    ASSERT_TRUE(reading) << kernel::outcome::text(reading.error());
  }
  EXPECT_GT(refused, 400000);
  EXPECT_GT(taken, 400000);
}

/// Readings that are anything at all.
class LyingEncoders final : public EncoderSource {
 public:
  Result<EncoderReading> next() override {
    EncoderReading reading;
    time_s_ +=
        dice_() % 30 == 0 ? -1.0 + 2.0 * static_cast<double>(dice_() % 1000) / 1000.0 : 0.004;
    reading.time_s = dice_() % 200 == 0 ? std::nan("") : time_s_;
    reading.counters = dice_() % 50 == 0 ? dice_() % 10 : 3;
    for (auto& count : reading.count) {
      count = dice_() % 10 == 0 ? static_cast<std::int64_t>(dice_()) << (dice_() % 32) : 1000;
    }
    reading.edge_s[0] = dice_() % 3 == 0 ? 1e300 : time_s_;
    reading.direction[0] = static_cast<std::int8_t>(dice_() % 3 - 1);
    return reading;
  }

 private:
  Dice dice_{9};
  double time_s_ = 0.0;
};

TEST(HostileLines, TheWholeLayerGoesOn) {
  Machine machine = wired_840d(0.040);
  LyingWires module(machine, 11, false);
  int faults = 0;
  int layers = 0;
  for (int i = 0; i < 30000; ++layers) {
    auto port = adapters::lines::LinesPort::make(machine, std::make_unique<OfAll>(module),
                                                 std::make_unique<LyingEncoders>())
                    .value();
    auto commanded = live::CommandedPort::make(*port, machine).value();
    auto layer = supervisor::Supervisor::make(machine, commanded->capability()).value();
    for (bool goes_on = true; goes_on && i < 30000; ++i) {
      const auto done = layer.cycle(*commanded, {});
      faults += done ? 0 : 1;
      goes_on = done || !has_let_go(done.error());
    }
    static_cast<void>(port->read());  // the exchange's thread has done its last write
  }
  EXPECT_GT(faults, 100);
  EXPECT_GT(layers, 10);
  EXPECT_EQ(module.wrong(), 0);
}

}  // namespace
}  // namespace steadyrest::test::lines
