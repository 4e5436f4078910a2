// SPDX-License-Identifier: Apache-2.0
// Who may connect, and to what: certificates, users, rights, names. All of it is refused before
// anything is written, with words that say what to do.
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <tests/opcua/live_rig.hpp>
#include <tests/opcua/scene.hpp>

#include <steadyrest/adapters/opcua/node_check.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/link/event.hpp>

namespace steadyrest::opcua {
namespace {

using adapters::opcua::BridgeClient;
using adapters::opcua::NodePlan;
using kernel::machine::Machine;

constexpr double kPatience_s = 60.0;

/// One server for all of them: it takes seconds to start. Its orders are read-only.
class Access : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    of_ = new Machine(machine());
    of_->opcua.reply_s = 10.0;  // a busy computer's
    give_state_folder(*of_);
    control_ = new ControlSide({.machine = *of_, .path = circles(*of_)});
    server_ = new Server(*of_, *control_, {{"orders_read_only", true}});
    of_->opcua.endpoint = server_->endpoint();
    trusting_ = new Machine(*of_);
    give_state_folder(*trusting_);
    trust(*trusting_);
  }
  static void TearDownTestSuite() {
    delete server_;
    delete control_;
    delete of_;
    delete trusting_;
  }

  /// The same control, and certificates of its own.
  static Machine fresh() {
    Machine out = *of_;
    give_state_folder(out);
    return out;
  }
  /// The same after `steadyrest opcua trust`.
  static Machine trusting() {
    Machine out = fresh();
    std::filesystem::copy(
        trusting_->opcua.certificates, out.opcua.certificates,
        std::filesystem::copy_options::recursive | std::filesystem::copy_options::skip_existing);
    return out;
  }
  static std::string why_not(const Machine& of) {
    const NodePlan plan(of.opcua);
    BridgeClient client(client_config(of), plan);
    const auto connected = client.connect(kPatience_s);
    return connected ? "connected" : kernel::outcome::text(connected.error());
  }
  static std::vector<std::string> faults(const Machine& of) {
    const NodePlan plan(of.opcua);
    BridgeClient client(client_config(of), plan);
    const auto connected = client.connect(kPatience_s);
    EXPECT_TRUE(connected) << kernel::outcome::text(connected.error());
    const auto checked = client.check();
    EXPECT_TRUE(checked) << kernel::outcome::text(checked.error());
    std::vector<std::string> out;
    for (const auto& fault : adapters::opcua::node_faults(*checked, plan, of.opcua)) {
      out.push_back(kernel::outcome::text(fault));
    }
    return out;
  }

  static Machine* of_;
  static ControlSide* control_;
  static Server* server_;
  static Machine* trusting_;
};
Machine* Access::of_ = nullptr;
ControlSide* Access::control_ = nullptr;
Server* Access::server_ = nullptr;
Machine* Access::trusting_ = nullptr;

MATCHER_P(Says, part, "") {
  return arg.find(part) != std::string::npos;
}

TEST_F(Access, ACertificateThatNobodyTrustsIsRefusedUntilItsFingerprintIsGiven) {
  const Machine of = fresh();
  EXPECT_THAT(why_not(of), Says("the control's certificate is not trusted"));
  const NodePlan plan(of.opcua);
  {
    BridgeClient client(client_config(of), plan);
    const auto wrong = client.trust(std::string(64, '0'));
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().what, Says("is not that of the control's certificate"));
  }
  EXPECT_THAT(why_not(of), Says("is not trusted"));
  trust(of);
  EXPECT_EQ(why_not(of), "connected");
}

TEST_F(Access, AnotherCertificateThanTheTrustedOneIsNamedAsSuch) {
  const Machine of = trusting();
  // As after a change of the control's: what was trusted is another one.
  const std::filesystem::path folder(of.opcua.certificates);
  std::filesystem::remove_all(folder / "controls");
  std::ofstream(folder / "controls.json")
      << "{\"" << of.opcua.endpoint << "\": \"" << std::string(64, 'a') << "\"}\n";
  EXPECT_THAT(why_not(of), Says("shows another certificate than the trusted one"));
}

TEST_F(Access, ACertificateIsTrustedForItsEndpointAlone) {
  const Machine of = trusting();
  const std::filesystem::path seen = std::filesystem::path(of.opcua.certificates) / "controls.json";
  std::string text = kernel::file::testing::text_of_file(seen.string());
  text.replace(text.find(of.opcua.endpoint), of.opcua.endpoint.size(), "opc.tcp://elsewhere:4840");
  std::ofstream(seen) << text;
  EXPECT_THAT(why_not(of), Says("is not trusted"));
}

TEST_F(Access, AnEmptyFileIsNoTrustedCertificate) {
  const Machine of = trusting();
  for (const auto& file :
       std::filesystem::directory_iterator(of.opcua.certificates + "/controls")) {
    std::filesystem::resize_file(file.path(), 0);
  }
  EXPECT_THAT(why_not(of), Says("is not trusted"));
}

TEST_F(Access, FaultsOfTheLayersOwnCertificateAreNamed) {
  const Machine of = trusting();
  const std::string own = of.opcua.certificates + "/own/";
  const std::string key = own + "private/private_key.pem";
  std::filesystem::permissions(key, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(why_not(of), Says("others may read the private key of the layer's certificate"));
  std::filesystem::permissions(key, std::filesystem::perms::others_read,
                               std::filesystem::perm_options::remove);
  std::filesystem::rename(key, key + ".lost");
  EXPECT_THAT(why_not(of), Says("private_key.pem is missing"));
  std::filesystem::rename(key + ".lost", key);
  std::filesystem::resize_file(key, 100);
  EXPECT_THAT(why_not(of), Says("the layer's own certificate or its key is damaged"));
  std::filesystem::remove_all(of.opcua.certificates);
  std::ofstream(of.opcua.certificates) << "a file in the folder's place\n";
  EXPECT_THAT(why_not(of), Says("the layer's own certificate cannot be made"));
}

TEST_F(Access, AWrongUserOrPasswordIsNamed) {
  Machine of = trusting();
  of.opcua.user = "nobody";
  EXPECT_THAT(why_not(of), Says("refuses the user or the password"));
}

TEST_F(Access, APasswordThatOthersMayReadIsRefused) {
  Machine of = trusting();
  std::filesystem::permissions(of.opcua.password_file, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(why_not(of), Says("others may read the password file"));
  of.opcua.password_file += "-none";
  EXPECT_THAT(why_not(of), Says("there is no password"));
}

TEST_F(Access, NoAnonymousUserAndNobodyWhoListens) {
  Machine of = trusting();
  of.opcua.user.clear();
  EXPECT_THAT(why_not(of), Says("the control wants a user"));
  of.opcua.endpoint = "opc.tcp://no-such-host.invalid:4840";
  EXPECT_THAT(why_not(of), Says("the endpoint's host is not known"));
  of.opcua.endpoint = "opc.tcp://127.0.0.1:9";
  EXPECT_THAT(why_not(of), Says("no OPC UA server listens there"));
}

TEST_F(Access, ReadOnlyOrdersUnknownNamesAndWrongTypesAreAllNamed) {
  Machine of = trusting();
  auto& reads = of.opcua.reads;
  const auto place = [&](kernel::machine::Quantity quantity) -> auto& {
    return *std::ranges::find(reads, quantity, &kernel::machine::OpcUaPlace::quantity);
  };
  place(kernel::machine::Quantity::motion_number).node = "s=/Plc/db21.dbb208";
  place(kernel::machine::Quantity::spindle_command_rpm).node =
      "s=/Channel/ProgramInfo/progName[u1]";
  place(kernel::machine::Quantity::time_s).length = 500;
  const auto all = faults(of);
  EXPECT_THAT(all, testing::Contains(Says("s=/Plc/db21.dbb208 is not on this control")));
  EXPECT_THAT(all,
              testing::Contains(Says("progName[u1] has the type String; it must be a number")));
  EXPECT_THAT(all, testing::Contains(Says("has 20 values; the mapping wants 500")));
  EXPECT_THAT(all, testing::Contains(Says("may not be written by this user")));
  EXPECT_EQ(all.size(), 4U);
}

TEST_F(Access, AnotherNamespaceIsNamed) {
  Machine of = trusting();
  of.opcua.uri = "urn:another:control";
  EXPECT_THAT(why_not(of), Says("does not have the mapping's namespace"));
}

TEST_F(Access, HostileValuesAreNotKnownOrPassedOnAsTheyAre) {
  Machine of = trusting();
  adapters::opcua::BridgeDevice device(client_config(of));
  adapters::opcua::Reading reading;
  const auto read = [&] {
    control_->step();
    const double until_s = kernel::link::monotonic_s() + kPatience_s;
    auto done = device.read(reading);
    while (!done && kernel::link::monotonic_s() < until_s) {
      done = device.read(reading);
    }
    return done;
  };
  server_->push(*control_);
  ASSERT_TRUE(read());
  control_->step();
  server_->push(*control_);
  const std::string node = "/Channel/Parameter/R[u1,700,#20]";
  auto block = control_->show("s=" + node).numbers;
  nlohmann::json values(block);
  values[4] = "nan";
  values[10] = "inf";
  values[11] = "huge";
  server_->ask({{"do", "hostile"}, {"values", {{node, values}}}});
  ASSERT_TRUE(device.read(reading));
  EXPECT_TRUE(std::isnan(reading[kernel::machine::Quantity::feed_panel_percent]));
  EXPECT_TRUE(std::isnan(reading(kernel::machine::Quantity::command_mm, 0)));
  EXPECT_EQ(reading(kernel::machine::Quantity::actual_mm, 0), 1e308);
  // Torn: the last number is another one.
  values[0] = block[0] + 5.0;
  server_->ask({{"do", "hostile"}, {"values", {{node, values}}}});
  const auto torn = device.read(reading);
  ASSERT_FALSE(torn);
  EXPECT_THAT(torn.error().what, Says("torn"));
  // Shorter than mapped: the last number is missing, and whether it is torn cannot be seen.
  server_->ask({{"do", "set"}, {"values", {{node, {1.0, 2.0}}}}});
  const auto without_last = device.read(reading);
  ASSERT_FALSE(without_last);
  EXPECT_THAT(without_last.error().what, Says("torn"));
  server_->ask({{"do", "status"}, {"node", node}, {"status", "BadCommunicationError"}});
  ASSERT_TRUE(device.read(reading));
  EXPECT_TRUE(std::isnan(reading[kernel::machine::Quantity::time_s]));
  server_->ask({{"do", "status"}, {"node", node}, {"status", "Good"}});
  // The control's side does not run: its sample stays.
  server_->push(*control_);
  static_cast<void>(device.read(reading));
  const auto same = device.read(reading);
  ASSERT_FALSE(same);
  EXPECT_THAT(same.error().what, Says("does not change"));
  // And none of it was an order: this user may write none.
  const auto written = device.write({.heartbeat = 1});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().what, Says("does not take"));
}

}  // namespace
}  // namespace steadyrest::opcua
