// SPDX-License-Identifier: Apache-2.0
// Override lines as a user tries them, with pymodbus as the module.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <thread>

#include "expectations.hpp"
#include "process.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/lines/module_server.hpp>

#include <steadyrest/adapters/lines/wires.hpp>
#include <steadyrest/passport/file/machine_file.hpp>

namespace steadyrest::test {
namespace {

using lines::ModuleServer;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// The words of 100 % on both switches of examples/machines/mill-802d.toml, and a running program.
constexpr std::uint64_t kPanel = 0b11010 | 0b01110 << 5 | 1 << 10;

/// examples/machines/mill-802d.toml on a module.
class Mill : public ::testing::Test {
 protected:
  Mill() : module_(ModuleServer::start()) {
    std::string text = text_of_file(project_file("examples/machines/mill-802d.toml"));
    const auto put = [&text](const std::string& was, const std::string& becomes) {
      text.replace(text.find(was), was.size(), becomes);
    };
    put("port = \"sim\"", "port = \"lines\"");
    put("192.168.0.50", module_->address());
    put("reply_ms = 50", "reply_ms = 10000");
    put("[contour]", "[contour]\nenabled = false");
    machine_ = scratch_.file("mill.toml", text);
    module_->exchange(kPanel, 0.0);
  }
  json tested(const std::string& options, int code) {
    const Finished finished = run_line("lines test --json --machine " + machine_ + " " + options);
    EXPECT_EQ(finished.code, code) << finished.err;
    return json::parse(finished.out);
  }

  /// Both switches from their first position to their last, while the program watches: each stays
  /// until the inputs were read twice more. `wired`: the word as the inputs carry it.
  json turned(int code, std::uint64_t (*wired)(std::uint64_t)) {
    const auto read = passport::read(machine_).value();
    const auto& feed = read.feed_override.code;
    const auto& spindle = read.spindle_override.code;
    const auto stands = [&](std::size_t i) {
      return wired(feed[std::min(i, feed.size() - 1)] | spindle[std::min(i, spindle.size() - 1)]
                                                            << 5U);
    };
    module_->exchange(stands(0), 0.0);
    const std::jthread operator_of([&](const std::stop_token& stop) {
      for (std::size_t i = 0; i < std::max(feed.size(), spindle.size()); ++i) {
        const std::uint64_t before = module_->exchange(stands(i), 0.0).reads;
        while (!stop.stop_requested() && module_->exchange(stands(i), 0.0).reads < before + 2) {
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
      }
    });
    return tested("--panel --for-s 300", code);
  }

  Scratch scratch_;
  std::unique_ptr<ModuleServer> module_;
  std::string machine_;
};

TEST_F(Mill, ListTouchesNothing) {
  const json answer = tested("--list", 0);
  const json& full = answer["feed"]["positions"][18];
  EXPECT_EQ(full["percent"], 100.0);
  EXPECT_EQ(full["code"], 0b11010);
  EXPECT_EQ(full["inputs_on"], json({1, 3, 4}));
  EXPECT_EQ(module_->exchange(kPanel, 0.0).written, 0U);
}

TEST_F(Mill, AWalkWithEveryMaskOffFindsAllWordsRight) {
  const json answer = tested("", 0);
  EXPECT_TRUE(answer["ok"]);
  EXPECT_EQ(answer["feed"]["outputs"]["words"].size(), 24U);
  const auto after = module_->exchange(kPanel, 0.0);
  EXPECT_EQ(after.outputs >> 5U & 1U, 0U);
  EXPECT_EQ(after.outputs >> 11U & 1U, 0U);
}

TEST_F(Mill, NobodyWalksTheWordUnderALayerThatActs) {
  std::string text = text_of_file(machine_);
  const std::string beat = "heartbeat = 12";
  text.erase(text.find(beat), beat.size());
  machine_ = scratch_.file("mill.toml", text);
  module_->tell("stick 5 1");
  const Finished test = run_line("lines test --machine " + machine_);
  EXPECT_EQ(test.code, 1);
  EXPECT_THAT(test.err, HasSubstr("output 5, a mask, is on: a layer acts on this module"));
  EXPECT_THAT(run_line("doctor --machine " + machine_).out,
              HasSubstr("warning: output 5, a mask, is on: a layer acts on this module"));
  const Finished start =
      run_line("run --for-s 0.1 --machine " + machine_ + " --socket " + scratch_.at("s"));
  EXPECT_EQ(start.code, 1);
  EXPECT_THAT(start.err, HasSubstr("output 5, a mask, is on: a layer acts on this module"));
  EXPECT_EQ(module_->exchange(kPanel, 0.0).written, 0U);
}

// A second layer that begins in the same moment sees nothing yet.
TEST_F(Mill, WhereAnotherClientWritesTheLayerLetsGoAndSaysSo) {
  const std::jthread other([this](const std::stop_token& stop) {
    auto lines = passport::read(machine_).value().lines;
    const auto wires = adapters::lines::open_wires(lines).value();
    for (bool on = false; !stop.stop_requested(); on = !on) {
      // It begins once this layer's first orders are there.
      if (module_->exchange(kPanel, 0.0).written > 0) {
        static_cast<void>(wires->write(adapters::lines::Levels(on ? 1 : 2)));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
  });
  Process acting({"run", "--mode", "act", "--machine", machine_, "--socket", scratch_.at("s")},
                 scratch_.at("."));
  std::string fault;
  for (int i = 0; i < 600 && fault.find("has let go of the outputs") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const Finished status = run_line("status --json --socket " + scratch_.at("s"));
    const json shown = status.code == 0 ? json::parse(status.out)["port_fault"] : json();
    fault = shown.is_string() ? shown.get<std::string>() : "";
  }
  EXPECT_THAT(fault, HasSubstr("again and again: the layer has let go of the outputs"));
  acting.send(SIGTERM);
  EXPECT_EQ(acting.wait(), 1) << acting.err();
}

TEST_F(Mill, AStuckOutputIsNamed) {
  module_->tell("stick 3 1");
  const json answer = tested("", 1);
  EXPECT_FALSE(answer["ok"]);
  EXPECT_THAT(answer["feed"]["outputs"]["faults"],
              ElementsAre("output 3: bit 3 stays 1: it touches the supply, or the line is dead"));
  EXPECT_THAT(answer["spindle"]["outputs"]["faults"], IsEmpty());
}

TEST_F(Mill, OutputsThatNeverChangeMayBeReadBackElsewhere) {
  for (int line = 0; line < 5; ++line) {
    module_->tell("stick " + std::to_string(line) + " 0");
  }
  const Finished test = run_line("lines test --machine " + machine_);
  EXPECT_EQ(test.code, 1);
  EXPECT_THAT(test.out, HasSubstr("[lines.feed] outputs: what is read back never changes"));
  EXPECT_THAT(test.out, Not(HasSubstr("[lines.spindle] outputs: what is read back never changes")));
}

TEST_F(Mill, SwappedWiresAreNamedByTheJumpersTest) {
  module_->tell("join 0:0 1:3 2:2 3:1 4:4 6:5 7:6 8:7 9:8 10:9");
  const json answer = tested("--jumpers", 1);
  EXPECT_THAT(answer["feed"]["inputs"]["faults"],
              ElementsAre("input 1: bit 1 carries bit 3: wires are swapped",
                          "input 3: bit 3 carries bit 1: wires are swapped"));
  EXPECT_THAT(answer["feed"]["outputs"]["faults"], IsEmpty());
  EXPECT_THAT(answer["spindle"]["inputs"]["faults"], IsEmpty());
}

TEST_F(Mill, AnOperatorWhoTurnsTheSwitchesFindsTheWiresRight) {
  const json answer = turned(0, [](std::uint64_t word) { return word; });
  EXPECT_EQ(answer["feed"]["inputs"]["words"].size(), 23U);
  EXPECT_EQ(answer["spindle"]["inputs"]["words"].size(), 15U);
  EXPECT_EQ(module_->exchange(kPanel, 0.0).written, 0U);
}

TEST_F(Mill, SwappedPanelWiresAreNamedWhileTheSwitchTurns) {
  const json answer = turned(1, [](std::uint64_t word) {
    return (word & ~std::uint64_t{0b1010}) | (word >> 2U & 0b10U) | (word & 0b10U) << 2U;
  });
  EXPECT_THAT(answer["feed"]["inputs"]["faults"],
              ElementsAre("input 1: bit 1 carries bit 3: wires are swapped",
                          "input 3: bit 3 carries bit 1: wires are swapped"));
  EXPECT_THAT(answer["spindle"]["inputs"]["faults"], IsEmpty());
}

TEST_F(Mill, DoctorNamesAPanelThatTheTableDoesNotKnow) {
  module_->exchange(0b10101 | 0b01110 << 5, 0.0);
  const Finished doctor = run_line("doctor --machine " + machine_);
  EXPECT_EQ(doctor.code, 1);
  EXPECT_THAT(doctor.out, HasSubstr("the feed panel shows 10101, which is not in [override.feed]"));
  const Finished start =
      run_line("run --for-s 0.1 --machine " + machine_ + " --socket " + scratch_.at("s"));
  EXPECT_EQ(start.code, 2);
  EXPECT_THAT(start.err, HasSubstr("lines test --panel"));
}

TEST_F(Mill, TheLayerRunsAndLeavesTheOutputsNeutral) {
  const Finished observed = run_line("run --json --for-s 0.3 --machine " + machine_ +
                                     " --mode observe --socket " + scratch_.at("s"));
  EXPECT_EQ(observed.code, 0) << observed.err;
  EXPECT_EQ(json::parse(observed.out)["port"], "lines");
  EXPECT_EQ(module_->exchange(kPanel, 0.0).written, 0U) << "observe writes nothing";
  Process acting({"run", "--machine", machine_, "--mode", "act", "--socket", scratch_.at("s")},
                 scratch_.at("."));
  for (int i = 0; i < 3000 && module_->exchange(kPanel, 0.0).written <= 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  acting.send(SIGTERM);
  EXPECT_EQ(acting.wait(), 0) << acting.err();
  const auto after = module_->exchange(kPanel, 0.0);
  EXPECT_GT(after.written, 3U);
  EXPECT_EQ(after.outputs >> 5U & 1U, 0U);
  EXPECT_EQ(after.outputs >> 11U & 1U, 0U);
}

// Counters have no device file; they are encoders all the same.
TEST_F(Mill, CountersAreEncodersThatAProgramCanFollow) {
  std::string text = text_of_file(machine_);
  std::string inputs;
  const auto encoders = encoder_count(passport::read(machine_).value());
  for (std::size_t i = 0; i < encoders; ++i) {
    inputs += (i == 0 ? "" : ", ") + std::string("999, ") + std::to_string(i);
  }
  text += "\n[recorder]\nkind = \"counter\"\ninputs = [" + inputs + "]\n";
  const std::string program = scratch_.file("part.mpf", "G0 X0\nM30\n");
  const Finished start =
      run_line("run --for-s 0.1 --machine " + scratch_.file("counters.toml", text) + " --program " +
               program + " --socket " + scratch_.at("s"));
  EXPECT_NE(start.code, 0);
  EXPECT_THAT(start.err, HasSubstr("counter999/count0 cannot be opened"));
}

TEST_F(Mill, AModuleThatIsNotThereIsRefusedByName) {
  const std::string address = module_->address();
  module_.reset();
  const Finished start =
      run_line("run --for-s 0.1 --machine " + machine_ + " --socket " + scratch_.at("s"));
  EXPECT_EQ(start.code, 1) << start.err;
  EXPECT_THAT(start.err, HasSubstr("the module " + address + " cannot be reached"));
  const Finished test = run_line("lines test --machine " + machine_);
  EXPECT_EQ(test.code, 1) << test.err;
  EXPECT_THAT(test.err, HasSubstr("cannot be reached"));
}

TEST(LinesTest, WithoutWiresThereIsNothingToTest) {
  expect_refused("lines test --machine examples/machines/vmc-840d.toml",
                 "there is no [lines] with the wires of an override");
}

}  // namespace
}  // namespace steadyrest::test
