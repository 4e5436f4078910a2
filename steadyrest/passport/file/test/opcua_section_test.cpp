// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/keys/schema.hpp>

namespace steadyrest::passport {
namespace {

using kernel::machine::OpcUaSecurity;
using kernel::machine::Quantity;
using testing::HasSubstr;

const std::string kOpcUaMachine = R"(port = "opcua"
[control]
dialect = "sinumerik"
interpolator_period_ms = 4
servo_period_ms = 2
[[axis]]
name = "X"
servo_gain_1_s = 50
max_feed_mm_min = 10000
max_acceleration_mm_s2 = 1000
[[axis]]
name = "Z"
servo_gain_1_s = 50
max_feed_mm_min = 10000
max_acceleration_mm_s2 = 1000
[override.feed]
percent = [0, 50, 100]
)";

const std::string kOpcUaSection = R"([opcua]
endpoint = "opc.tcp://control:4840"
mapping = "mapping.toml"
security = "none"
user = "layer"
password_file = "secret"
certificates = "keys"
cycle_ms = 10
reply_ms = 100
channel = 2
sample_r = 10
order_r = 40
work_r = 60
first_action = 20
dead_man_ms = 50
hand_back_percent_s = 150
spindle = "S2"
machine_axes = "MX MZ"
plc_block = 200
spindle_axis = 5
program = "part.mpf"
)";

const std::string kMapping = R"(name = "test"
namespace = "urn:test"
[[read]]
quantity = "feed_panel_percent"
node = "s=/Ch{channel}/panel"
[[read]]
quantity = "command_mm"
node = "s=/R[u{channel},{sample},#{sample_count}]"
index = 3
step = 2
scale = 0.001
offset = 1
[[read]]
quantity = "actual_mm"
node = "s=/axis[{axis}]"
[[read]]
quantity = "sample_end"
node = "s=/R[u{channel},{sample},#{sample_count}]"
index = -1
[[read]]
quantity = "program_state"
node = "i=77"
[[write]]
quantity = "heartbeat"
node = "s=/W"
index = 2
length = 3
[[write]]
quantity = "masks_feed"
node = "s=/W"
length = 3
[[write]]
quantity = "masks_spindle"
node = "s=/W"
index = 1
length = 3
[program_state]
running = [1, 2]
stopped = [0]
)";

class OpcUaSection : public testing::Test {
 protected:
  AllFaults read(const std::string& machine, const std::string& mapping) {
    std::ofstream(folder + "/mapping.toml") << mapping;
    std::ofstream(folder + "/machine.toml") << machine;
    return read_all_faults(folder + "/machine.toml");
  }
  /// All faults of a machine file with one thing changed, in one text.
  std::string faults(const std::string& from, const std::string& to, bool in_mapping = false) {
    std::string machine = kOpcUaMachine + kOpcUaSection;
    std::string mapping = kMapping;
    std::string& text = in_mapping ? mapping : machine;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const auto got = read(machine, mapping);
    std::string out;
    if (!got) {
      for (const auto& fault : got.error()) {
        out += kernel::outcome::text(fault) + "\n";
      }
    }
    return out;
  }

  kernel::file::testing::OwnFolder own;
  std::string folder = own.path().string();
};

TEST_F(OpcUaSection, EveryKeyIsReadAndPathsBeginAtTheMachineFile) {
  const auto read_file = read(kOpcUaMachine + kOpcUaSection, kMapping);
  ASSERT_TRUE(read_file) << kernel::outcome::text(read_file.error().front());
  const auto& of = read_file->opcua;
  EXPECT_EQ(of.endpoint, "opc.tcp://control:4840");
  EXPECT_EQ(of.mapping, folder + "/mapping.toml");
  EXPECT_EQ(of.security, OpcUaSecurity::none);
  EXPECT_EQ(of.user, "layer");
  EXPECT_EQ(of.password_file, folder + "/secret");
  EXPECT_EQ(of.certificates, folder + "/keys");
  EXPECT_EQ(of.program, folder + "/part.mpf");
  EXPECT_DOUBLE_EQ(of.cycle_s, 0.01);
  EXPECT_DOUBLE_EQ(of.reply_s, 0.1);
  EXPECT_DOUBLE_EQ(of.dead_man_s, 0.05);
  EXPECT_DOUBLE_EQ(of.hand_back_1_s, 1.5);
  EXPECT_EQ(of.channel, 2U);
  EXPECT_EQ(of.first_sample, 10U);
  EXPECT_EQ(of.first_order, 40U);
  EXPECT_EQ(of.first_work, 60U);
  EXPECT_EQ(of.first_action, 20U);
  EXPECT_EQ(of.spindle, "S2");
  EXPECT_EQ(of.machine_axes, "MX MZ");
  EXPECT_EQ(of.plc_block, 200U);
  EXPECT_EQ(of.spindle_axis, 5U);
  EXPECT_EQ(layer_cycle_s(*read_file), of.cycle_s);
  const std::string text = kOpcUaSection + "password_variable";
  for (const auto& key : opcua_keys()) {
    EXPECT_NE(text.find(key.name), std::string::npos) << key.name << " is not in this test";
  }
}

TEST_F(OpcUaSection, BlocksEndWithinTheControlsRParameters) {
  std::string section = kOpcUaSection;
  section.replace(section.find("work_r = 60"), 11, "work_r = 32530");
  const auto refused = read(kOpcUaMachine + section, kMapping);
  ASSERT_FALSE(refused);
  EXPECT_THAT(kernel::outcome::text(refused.error().front()),
              HasSubstr("work_r takes R32530 to R32545; R32535 is the last there can be"));
}

TEST_F(OpcUaSection, PlaceholdersAreFilledInForEachAxisThatIsThere) {
  const auto machine = read(kOpcUaMachine + kOpcUaSection, kMapping).value();
  const auto& reads = machine.opcua.reads;
  ASSERT_EQ(reads.size(), 7U);
  EXPECT_EQ(machine.opcua.uri, "urn:test");
  EXPECT_EQ(reads[0].node, "s=/Ch2/panel");
  // Two axes: 11 + 3·2 values. Z is the third of the machine's, but the second that is there.
  EXPECT_EQ(reads[1].node, "s=/R[u2,10,#17]");
  EXPECT_EQ(reads[1].length, 17U);
  EXPECT_EQ(reads[1].axis, 0U);
  EXPECT_EQ(reads[2].axis, 2U);
  EXPECT_EQ(reads[2].index, 5U);
  EXPECT_EQ(reads[2].scale, 0.001);
  EXPECT_EQ(reads[2].offset, 1.0);
  EXPECT_EQ(reads[4].node, "s=/axis[2]");
  EXPECT_EQ(reads[5].index, 16U);
  EXPECT_EQ(machine.opcua.writes.front().length, 3U);
  EXPECT_EQ(machine.opcua.states[2], (std::vector<double>{1, 2}));
}

TEST_F(OpcUaSection, WhatDoesNotFitIsRefusedWithItsPlace) {
  EXPECT_THAT(faults("opc.tcp://", "http://"), HasSubstr("machine.toml:19: endpoint = \"http"));
  for (const char* const endpoint : {"opc.tcp://a:0", "opc.tcp://a:99999", "opc.tcp://[::1",
                                     "opc.tcp://user:pw@a:4840", "opc.tcp://"}) {
    EXPECT_THAT(faults("opc.tcp://control:4840", endpoint),
                HasSubstr(std::string("machine.toml:19: endpoint = \"") + endpoint));
  }
  EXPECT_THAT(faults("opc.tcp://control:4840", "opc.tcp://[fe80::1]/server"),
              HasSubstr("with a name or an IPv4 number"));
  EXPECT_EQ(faults("opc.tcp://control:4840", "opc.tcp://control/server"), "");
  EXPECT_THAT(faults("spindle = \"S2\"\nmachine_axes = \"MX MZ\"", "spindle = \"X1\""),
              HasSubstr("X1 is the name of two axes"));
  EXPECT_THAT(faults("MX MZ", "MX MZ MX"), HasSubstr("MX is the name of two axes"));
  EXPECT_THAT(faults("MX MZ", "MX S2"), HasSubstr("S2 is the name of two axes"));
  EXPECT_THAT(faults("MX MZ", "MX"), HasSubstr("machine_axes has 1 names; the machine has 2 axes"));
  EXPECT_THAT(faults("password_file = \"secret\"\n", ""), HasSubstr("a user without a password"));
  EXPECT_THAT(faults("user = \"layer\"\n", ""), HasSubstr("a password without a user"));
  EXPECT_THAT(faults("certificates", "password_variable = \"P\"\ncertificates"),
              HasSubstr("both password_file and password_variable"));
  EXPECT_THAT(faults("dead_man_ms = 50", "dead_man_ms = 25"),
              HasSubstr("dead_man_ms = 25 is less than three cycles"));
  EXPECT_THAT(faults("order_r = 40", "order_r = 20"), HasSubstr("sample_r takes R10 to R26"));
  EXPECT_THAT(faults("mapping.toml", "none.toml"), HasSubstr("none.toml cannot be opened"));
  EXPECT_THAT(faults("security = \"none\"", "security = \"Basic128\""), HasSubstr("security"));
  const auto absent = parse(kOpcUaMachine, "m.toml");
  ASSERT_FALSE(absent);
  EXPECT_THAT(absent.error().what, HasSubstr("there is no [opcua]"));
}

TEST_F(OpcUaSection, AFaultyMappingIsRefusedWithItsOwnFileAndLine) {
  const auto mapping = [this](const std::string& from, const std::string& to) {
    return faults(from, to, true);
  };
  EXPECT_THAT(mapping("\"command_mm\"", "\"comand_mm\""),
              HasSubstr("mapping.toml:7: quantity = \"comand_mm\""));
  EXPECT_THAT(mapping("\"command_mm\"", "\"comand_mm\""), HasSubstr("command_mm"));
  EXPECT_THAT(mapping("quantity = \"heartbeat\"", "quantity = \"time_s\""),
              HasSubstr("is none that is written"));
  EXPECT_THAT(mapping("namespace = \"urn:test\"\n", ""), HasSubstr("no namespace"));
  EXPECT_THAT(mapping("{sample}", "{simple}"), HasSubstr("{simple}"));
  EXPECT_THAT(mapping("step = 2", "step = 100"), HasSubstr("index 103 is beyond the 17 values"));
  EXPECT_THAT(mapping("scale = 0.001", "scale = 0"), HasSubstr("scale = 0"));
  EXPECT_THAT(mapping("\"sample_end\"", "\"feed_panel_percent\""), HasSubstr("mapped twice"));
  EXPECT_THAT(mapping("quantity = \"masks_spindle\"\nnode = \"s=/W\"",
                      "quantity = \"masks_spindle\"\nnode = \"s=/V\""),
              HasSubstr("2 of the 3 values of s=/W are mapped"));
  EXPECT_THAT(mapping("[program_state]",
                      "[[write]]\nquantity = \"feed_percent\"\nnode = \"s=/W\"\nindex = 2\n"
                      "length = 3\n[program_state]"),
              HasSubstr("feed_percent has the place of heartbeat: s=/W entry 2"));
  EXPECT_THAT(mapping("[program_state]",
                      "[[write]]\nquantity = \"heartbeat_byte\"\nnode = \"s=/B\"\n[program_state]"),
              HasSubstr("both heartbeat and heartbeat_byte"));
  EXPECT_THAT(mapping("s=/Ch{channel}/panel\"", "s=/W\"\nindex = 2\nlength = 3"),
              HasSubstr("feed_panel_percent is read at s=/W entry 2, where the override in force"));
  EXPECT_THAT(mapping("step = 2\n", ""), HasSubstr("give each axis a separate place"));
  EXPECT_THAT(mapping("stopped = [0]", "stopped = [0, 2]"),
              HasSubstr("program_state 2 is both stopped and running"));
  EXPECT_THAT(mapping("\"actual_mm\"", "\"offset_mm\""), HasSubstr("the mapping has no actual_mm"));
  EXPECT_THAT(mapping("quantity = \"heartbeat\"", "quantity = \"feed_percent\""),
              HasSubstr("no heartbeat"));
  EXPECT_THAT(mapping("running = [1, 2]\n", ""), HasSubstr("does not say what running is"));
  EXPECT_THAT(mapping("name = \"test\"", "nome = \"test\""), HasSubstr("a mapping has no nome"));
  EXPECT_THAT(mapping("i=77", "77"), HasSubstr("node = \"77\""));
  EXPECT_THAT(mapping("[[write]]", "[[write"), HasSubstr("mapping.toml:"));
}

/// The example machine with another of the example mappings.
auto by_mapping(const std::string& name, const std::string& more = "") {
  std::ifstream in(STEADYREST_SOURCE_DIR "/examples/machines/vmc-840d-opcua.toml");
  std::string text((std::istreambuf_iterator<char>(in)), {});
  const std::string old = "sinumerik-840d-sl.toml\"\n";
  text.replace(text.find(old), old.size(), name + ".toml\"\n" + more);
  return parse(text, STEADYREST_SOURCE_DIR "/examples/machines/x.toml");
}

TEST(OpcUaMappings, TheExamplesFitAMachine) {
  for (const std::string name :
       {"sinumerik-840d-sl", "sinumerik-single-nodes", "sinumerik-plc", "other-control"}) {
    const auto read = by_mapping(name);
    ASSERT_TRUE(read) << kernel::outcome::text(read.error());
    EXPECT_FALSE(read->opcua.reads.empty());
  }
}

TEST(OpcUaMappings, DataBlocksAreThoseOfTheMachineFile) {
  const auto read = by_mapping("sinumerik-plc", "channel = 3\nplc_block = 180\n");
  ASSERT_TRUE(read) << kernel::outcome::text(read.error());
  const auto node = [](const auto& places, Quantity quantity) {
    return std::ranges::find(places, quantity, &kernel::machine::OpcUaPlace::quantity)->node;
  };
  EXPECT_EQ(node(read->opcua.reads, Quantity::motion_number), "s=/Plc/DB23.DBB208");
  EXPECT_EQ(node(read->opcua.reads, Quantity::layer_alive), "s=/Plc/DB180.DBB4");
  EXPECT_EQ(node(read->opcua.writes, Quantity::heartbeat_byte), "s=/Plc/DB180.DBB0");
}

}  // namespace
}  // namespace steadyrest::passport
