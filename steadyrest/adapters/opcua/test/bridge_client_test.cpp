// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <steadyrest/adapters/opcua/bridge_client.hpp>
#include <steadyrest/adapters/opcua/words.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::adapters::opcua {
namespace {

/// A shell script in the bridge's place.
BridgeClient::Config bridge_of(const std::string& folder, const std::string& script) {
  const std::string file = folder + "/bridge.sh";
  std::ofstream(file) << script;
  BridgeClient::Config config;
  config.process = {.node = "sh", .script = file};
  config.machine.reply_s = 0.1;
  return config;
}

TEST(BridgeClient, ABridgeThatTalksWithoutEndIsEnded) {
  const kernel::file::testing::OwnFolder folder;
  const auto config = bridge_of(folder.path().string(),
                                "echo '{\"event\":\"hello\",\"protocol\":1}' >&3\n"
                                "exec yes '{\"event\":\"state\",\"state\":\"connected\"}' >&3\n");
  const NodePlan plan(config.machine);
  BridgeClient client(config, plan);
  const auto connected = client.connect(20.0);
  ASSERT_TRUE(connected) << kernel::outcome::text(connected.error());
  const auto read = client.read();
  ASSERT_FALSE(read) << "and the thread is free again";
  EXPECT_EQ(read.error().what, "the OPC UA bridge does not answer");
}

TEST(BridgeClient, ABridgeThatEndedOrHungIsCalledSo) {
  const kernel::machine::OpcUa machine;
  EXPECT_EQ(refusal_of("bridge_ended", "", machine).what.find("the OPC UA bridge has ended"), 0U);
  EXPECT_EQ(refusal_of("bridge_hangs", "", machine).what.find("the OPC UA bridge does not"), 0U);
}

}  // namespace
}  // namespace steadyrest::adapters::opcua
