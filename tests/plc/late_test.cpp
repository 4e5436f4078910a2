// SPDX-License-Identifier: Apache-2.0
// The layer's two blocks for a PLC, run as their text has it: FB 310 of docs/wiring.md, and
// STEADYREST.SCL. A layer that is late raises nothing; a dead one is out in the stated time.
#include <algorithm>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <tests/plc/scl_block.hpp>

#include <steadyrest/adapters/opcua/control_text.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/override/table.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::plc {
namespace {

constexpr long kScan_ms = 10;
constexpr long kBeat_ms = 20;
constexpr long kPanel = 19;
constexpr long kHeld = 5;

long gray(long position) {
  return position ^ (position >> 1);
}

/// What the control gets, one scan after the other.
class Scans {
 public:
  virtual ~Scans() = default;
  /// The word of the layer and its heartbeat; `asks`: with its mask.
  virtual void order(long position, bool asks) = 0;
  /// One scan with the operator's switch there; the position that the control gets.
  virtual long scan(long panel) = 0;
  [[nodiscard]] virtual long limit_ms() const = 0;
  [[nodiscard]] virtual long step_ms() const = 0;
};

class WiredBlock final : public Scans {
 public:
  WiredBlock()
      : block_(kernel::file::testing::text_of_file(STEADYREST_SOURCE_DIR "/docs/wiring.md")) {}
  void order(long position, bool asks) override {
    block_["layer"] = gray(position);
    block_["ask"] = asks ? 1 : 0;
    block_["heartbeat"] = 1 - block_["heartbeat"];
  }
  /// A module's watchdog, or its supply.
  void drop_outputs() { block_["layer"] = block_["ask"] = block_["heartbeat"] = 0; }
  long scan(long panel) override {
    block_["panel"] = gray(panel);
    block_["g_code"] = 2;
    now_ms_ += kScan_ms;
    block_.call(now_ms_);
    long position = block_["word_out"];
    for (long shift = position >> 1; shift != 0; shift >>= 1) {
      position ^= shift;
    }
    return position;
  }
  [[nodiscard]] long limit_ms() const override { return 1000; }
  [[nodiscard]] long step_ms() const override { return 20; }
  long& operator[](const std::string& name) { return block_[name]; }

 private:
  SclBlock block_;
  long now_ms_ = 5000;
};

kernel::machine::Machine by_plc() {
  auto of = passport::read(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d-opcua.toml").value();
  of.opcua.writes.push_back(
      {.quantity = kernel::machine::Quantity::feed_position, .node = "s=/Plc/DB170.DBB2"});
  return of;
}

class NetworkBlock final : public Scans {
 public:
  NetworkBlock()
      : table_(kernel::override::Table::make(by_plc().feed_override).value()),
        block_(adapters::opcua::control_texts(by_plc()).value()[2].text) {}
  void order(long position, bool asks) override {
    block_["DB170.FeedPosition"] = position;
    block_["DB170.Mask"] = asks ? 1 : 0;
    block_["DB170.Heartbeat"] = 1 + block_["DB170.Heartbeat"] % 250;
  }
  long scan(long panel) override {
    // The panel's block writes before this one, in every cycle.
    block_["DB21.DB4"] = table_.code(static_cast<std::size_t>(panel - 1));
    now_ms_ += kScan_ms;
    block_.call(now_ms_);
    const auto step = table_.step_of_code(static_cast<std::uint32_t>(block_["DB21.DB4"]));
    return step ? static_cast<long>(*step) + 1 : 0;
  }
  [[nodiscard]] long limit_ms() const override { return 1000; }
  [[nodiscard]] long step_ms() const override { return 50; }

 private:
  kernel::override::Table table_;
  SclBlock block_;
  long now_ms_ = 5000;
};

template <class Block>
class LateInThePlc : public testing::Test {
 protected:
  /// A layer in time that holds its word.
  void hold(long time_ms) {
    for (long t = 0; t < time_ms; t += kScan_ms) {
      if (t % kBeat_ms == 0) {
        block.order(kHeld, true);
      }
      block.scan(kPanel);
    }
    ASSERT_EQ(block.scan(kPanel), kHeld);
  }
  Block block;
};

using Blocks = testing::Types<WiredBlock, NetworkBlock>;
TYPED_TEST_SUITE(LateInThePlc, Blocks);

TYPED_TEST(LateInThePlc, NothingRisesHoweverManyHeartbeatsAreLostWithinTheLimit) {
  std::mt19937 random(5);
  std::uniform_int_distribution<long> any_ms(1, this->block.limit_ms() - 4 * kScan_ms);
  this->hold(500);
  for (int i = 0; i < 30; ++i) {
    const long late_ms = i == 0 ? this->block.limit_ms() - 4 * kScan_ms : any_ms(random);
    for (long t = 0; t < late_ms; t += kScan_ms) {
      ASSERT_EQ(this->block.scan(kPanel), kHeld) << late_ms << " ms late, at " << t;
    }
    this->block.order(kHeld, true);
    ASSERT_EQ(this->block.scan(kPanel), kHeld) << "it goes on";
  }
}

TYPED_TEST(LateInThePlc, ThePanelWinsMeanwhile) {
  this->hold(500);
  for (const long panel : {12L, 3L, 2L, 5L, 23L, 1L}) {
    long position = this->block.scan(panel);
    ASSERT_LE(position, std::min(panel, kHeld)) << panel;
    for (int i = 0; i < 9; ++i) {  // it rises position by position
      position = this->block.scan(panel);
      ASSERT_LE(position, std::min(panel, kHeld)) << panel;
    }
    EXPECT_EQ(position, std::min(panel, kHeld)) << panel;
  }
}

TYPED_TEST(LateInThePlc, ADeadLayersWordEndsInTheStatedTimePositionByPosition) {
  this->hold(500);
  long before = kHeld;
  long t = kScan_ms;
  for (; before < kPanel; t += kScan_ms) {
    const long now = this->block.scan(kPanel);
    ASSERT_LE(now - before, 1) << "at " << t << " ms";
    ASSERT_TRUE(now == kHeld || t >= this->block.limit_ms() - 3 * kScan_ms) << t;
    before = now;
    ASSERT_LT(t, 10000);
  }
  const long stated_ms = this->block.limit_ms() + (kPanel - kHeld) * this->block.step_ms();
  EXPECT_LE(t, stated_ms + 2 * kScan_ms);
  EXPECT_GE(t, stated_ms - this->block.step_ms() - 4 * kScan_ms);
  EXPECT_EQ(this->block.scan(2), 2);
  EXPECT_EQ(this->block.scan(kPanel), kPanel) << "the panel turns freely again";
}

TYPED_TEST(LateInThePlc, HandingBackOnPurposeIsNotHeld) {
  this->hold(500);
  long position = kHeld;
  for (long t = 0; t < (kPanel - kHeld + 1) * this->block.step_ms(); t += kScan_ms) {
    if (t % kBeat_ms == 0) {
      this->block.order(kPanel, false);
    }
    position = this->block.scan(kPanel);
  }
  EXPECT_EQ(position, kPanel);
}

// The module's watchdog is shorter than the limit, and its heartbeat line falls with the others or
// was low already.
TEST(WiredBlockLate, OutputsThatAWatchdogDropsRaiseNothingBeforeTheLimit) {
  for (const bool beat : {false, true}) {
    WiredBlock block;
    for (int i = 0; i < 50; ++i) {
      block.order(kHeld, true);
      block.scan(kPanel);
      block.scan(kPanel);
    }
    if ((block["heartbeat"] != 0) != beat) {
      block.order(kHeld, true);
    }
    for (long t = 0; t < 300; t += kScan_ms) {
      ASSERT_EQ(block.scan(kPanel), kHeld);
    }
    block.drop_outputs();
    long t = 300;
    for (; block.scan(kPanel) == kHeld; t += kScan_ms) {
      ASSERT_LT(t, block.limit_ms() + 4 * kScan_ms);
    }
    EXPECT_GE(t, block.limit_ms() - 4 * kScan_ms);
  }
}

TEST(SclBlock, RefusesWhatItDoesNotKnow) {
  EXPECT_THROW(SclBlock("no block"), std::runtime_error);
  SclBlock block(
      "FUNCTION_BLOCK F\nVAR x : INT; END_VAR\nBEGIN\nx := SQRT(2);\nEND_FUNCTION_BLOCK\n");
  EXPECT_THROW(block.call(0), std::runtime_error);
}

}  // namespace
}  // namespace steadyrest::plc
