// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/record/recording_port.hpp>
#include <steadyrest/record/replay_port.hpp>
#include <steadyrest/record/test/samples.hpp>

namespace steadyrest::record {
namespace {

using kernel::outcome::Kind;
using kernel::outcome::Refusal;
using kernel::outcome::Result;

constexpr kernel::signal::Command kWritten{.write = true};

/// Counts its cycles; does not read the second time and does not write the third.
class Failing final : public kernel::port::Port {
 public:
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return {.spindle_override = true};
  }
  Result<kernel::signal::Frame> read() noexcept override {
    if (++reads_ == 2) {
      return std::unexpected(Refusal{Kind::unavailable, "", 0, "no frame", "wait"});
    }
    kernel::signal::Frame frame;
    frame.cycle = reads_;
    return frame;
  }
  Result<void> write(const kernel::signal::Command& /*command*/) noexcept override {
    if (reads_ == 3) {
      return std::unexpected(Refusal{Kind::unavailable, "", 0, "not taken", "wait"});
    }
    return {};
  }

 private:
  std::uint64_t reads_ = 0;
};

TEST(ReplayPort, FailsWhereTheMachineDid) {
  const test::Folder folder;
  {
    const auto writer = RecordWriter::make({.file = folder.file("a.sqlite"),
                                            .info = {.capability = Failing().capability()}})
                            .value();
    Failing machine;
    RecordingPort port(machine, *writer);
    writer->event(EventKind::mode, "act");
    for (int i = 0; i < 4; ++i) {
      if (port.read() && port.write(kWritten)) {
        port.record({});
      }
    }
    writer->event(EventKind::mode, "observe");
  }
  const auto port = ReplayPort::open(folder.file("a.sqlite")).value();
  EXPECT_TRUE(port->capability().spindle_override);
  EXPECT_FALSE(port->capability().feed_override);
  EXPECT_EQ(port->change_due()->text, "act");
  EXPECT_EQ(port->change_due(), nullptr);
  EXPECT_EQ(port->read().value().cycle, 1U);
  EXPECT_EQ(port->write({}).error().kind, Kind::bad_input) << "not in the mode act";
  EXPECT_TRUE(port->write(kWritten));
  EXPECT_EQ(port->read().error().what, "no frame");
  EXPECT_EQ(port->read().value().cycle, 3U);
  EXPECT_EQ(port->write(kWritten).error().what, "not taken");
  EXPECT_EQ(port->change_due(), nullptr);
  EXPECT_EQ(port->read().value().cycle, 4U);
  EXPECT_TRUE(port->write(kWritten));
  EXPECT_FALSE(port->finished());
  EXPECT_EQ(port->change_due()->text, "observe");
  EXPECT_TRUE(port->finished());
  EXPECT_EQ(port->read().error().kind, Kind::unavailable);
}

}  // namespace
}  // namespace steadyrest::record
