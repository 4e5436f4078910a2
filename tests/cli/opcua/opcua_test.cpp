// SPDX-License-Identifier: Apache-2.0
// A control with an OPC UA server, as a user meets it: its certificate, `doctor`, a run that
// observes and one that acts. The server is node-opcua, the bridge the shipped one.
#include <chrono>
#include <csignal>
#include <memory>
#include <string>
#include <thread>

#include "process.hpp"
#include "program.hpp"
#include "scratch.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tests/opcua/real_time_control.hpp>
#include <tests/opcua/scene.hpp>

namespace steadyrest::test {
namespace {

using nlohmann::json;
using opcua::RealTimeControl;
using ::testing::HasSubstr;

/// Circles for the whole test: R = 10 mm at 3000 mm/min, which the layer has to slow down.
std::unique_ptr<RealTimeControl> control() {
  return std::make_unique<RealTimeControl>(
      project_file("examples/machines/vmc-840d-opcua.toml"),
      opcua::path_of("G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 TURN=400 F3000\nM30\n",
                     opcua::machine()));
}

TEST(OpcUaAsAUserMeetsIt, ACertificateIsTrustedOnceAndOrdersComeFromActModeAlone) {
  const auto machine = control();
  const Scratch scratch;
  const std::string of = " --machine " + machine->machine_file();
  const std::string socket = " --socket " + scratch.at("s");

  const Finished before = run_line("doctor" + of);
  EXPECT_EQ(before.code, 1) << before.err;
  EXPECT_THAT(before.out, HasSubstr("certificate is not trusted"));
  EXPECT_THAT(before.out, HasSubstr("opcua trust"));
  const Finished early = run_line("run --for-s 0.1 --mode act" + of + socket);
  EXPECT_EQ(early.code, 1);
  EXPECT_THAT(early.err, HasSubstr("certificate is not trusted"));

  const Finished nowhere = run_line("run --for-s 0.1 --program /nonexist.mpf" + of + socket);
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("/nonexist.mpf: there is no such program file"));

  const json shown = json::parse(run_line("opcua trust --json" + of).out);
  EXPECT_FALSE(shown["trusted"]);
  const std::string fingerprint = shown["fingerprint"];
  EXPECT_EQ(fingerprint.size(), 64U);
  const Finished wrong = run_line("opcua trust --fingerprint " + std::string(64, '0') + of);
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("is not that of the control's certificate"));
  EXPECT_EQ(run_line("opcua trust --fingerprint " + fingerprint + of).code, 0);
  EXPECT_TRUE(json::parse(run_line("opcua trust --json" + of).out)["trusted"]);

  const Finished doctor = run_line("doctor" + of);
  EXPECT_EQ(doctor.code, 0) << doctor.out << doctor.err;
  const Finished observed = run_line("run --json --for-s 1 --mode observe" + of + socket);
  EXPECT_EQ(observed.code, 0) << observed.err;
  EXPECT_EQ(json::parse(observed.out)["port"], "opcua");
  EXPECT_EQ(machine->seen().obeyed_cycles, 0U);
  EXPECT_EQ(machine->seen().least_feed_ratio, 1.0);

  Process acting(
      {"run", "--mode", "act", "--machine", machine->machine_file(), "--socket", scratch.at("s")},
      scratch.at("."));
  const auto obeys_for = [&](std::size_t cycles) {
    const std::size_t until = machine->seen().obeyed_cycles + cycles;
    for (int i = 0; i < 3000 && machine->seen().obeyed_cycles < until; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  };
  obeys_for(200);
  // What a second layer meets.
  const Finished beside =
      run_line("run --for-s 0.1 --mode act" + of + " --socket " + scratch.at("t"));
  EXPECT_EQ(beside.code, 1);
  EXPECT_THAT(beside.err, HasSubstr("another layer acts on this control"));
  obeys_for(20);
  acting.send(SIGTERM);
  EXPECT_EQ(acting.wait(), 0) << acting.err();
  const auto seen = machine->seen();
  EXPECT_GT(seen.obeyed_cycles, 100U);
  EXPECT_LT(seen.least_feed_ratio, 0.9);
  EXPECT_FALSE(seen.finished) << "the program was long enough";
}

}  // namespace
}  // namespace steadyrest::test
