// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live {
namespace {

using kernel::signal::Frame;
using kernel::signal::ProgramState;
using nc::follow::Place;
using nc::follow::Route;

/// A machine that hides its path, as real controls do.
class Hidden final : public kernel::port::Port {
 public:
  explicit Hidden(Port& machine) : machine_(machine) {}
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return machine_.capability();
  }
  kernel::outcome::Result<Frame> read() noexcept override {
    auto frame = machine_.read();
    if (frame) {
      truth = *frame;
      frame->path = {};
      frame->path_index = 0;
      frame->path_position_mm = 0.0;
      frame->program = program;
    }
    return frame;
  }
  kernel::outcome::Result<void> write(const kernel::signal::Command& command) noexcept override {
    return machine_.write(command);
  }
  Frame truth;
  ProgramState program = ProgramState::running;

 private:
  Port& machine_;
};

TEST(FollowedPort, ShowsThePathThatTheMachineHides) {
  test::Desk desk;
  Hidden hidden(*desk.port);
  FollowedPort followed(hidden);
  const auto before = followed.read();
  ASSERT_TRUE(before.has_value());
  EXPECT_TRUE(before->path.empty());
  EXPECT_EQ(followed.place(), Place::no_route);
  followed.offer(
      std::make_shared<const Route>(std::vector(before->path.begin(), before->path.end())));
  followed.offer(std::make_shared<const Route>(
      std::vector(hidden.truth.path.begin(), hidden.truth.path.end())));
  std::size_t found = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto frame = followed.read();
    ASSERT_TRUE(frame.has_value());
    if (!frame->path.empty() && frame->path_speed_mm_s > 0.0) {
      ++found;
      EXPECT_EQ(followed.place(), Place::on_path);
      EXPECT_EQ(frame->path.size(), hidden.truth.path.size());
      EXPECT_NEAR(frame->path_position_mm, hidden.truth.path_position_mm, 1e-4) << i;
    }
  }
  EXPECT_GT(found, 290U);
  hidden.program = ProgramState::stopped;
  EXPECT_TRUE(followed.read()->path.empty());
  EXPECT_EQ(followed.place(), Place::no_program);
}

TEST(FollowedPort, ShowsTheOriginalBesideThePathAndThatItIsNotKnownElsewhere) {
  test::Desk desk;
  Hidden hidden(*desk.port);
  FollowedPort followed(hidden);
  (void)hidden.read();
  const std::vector segments(hidden.truth.path.begin(), hidden.truth.path.end());
  followed.tell({.path = true, .heat = true});
  followed.offer(std::make_shared<const Route>(segments, std::vector<bool>(), segments));
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const auto frame = followed.read();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->original.size(), frame->path.size());
    EXPECT_EQ(frame->original_unknown, frame->path.empty());
    EXPECT_TRUE(frame->heat_in_text);
    found += frame->original.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 100);
  hidden.program = ProgramState::stopped;
  EXPECT_FALSE(followed.read()->original_unknown) << "no program runs";
  EXPECT_FALSE(followed.read()->heat_in_text);
}

// The control tells its PLC of the G code once in a scan, and a thread may be over by then.
TEST(FollowedPort, AThreadOfTheProgramIsOneThoughTheControlShowsAFeed) {
  test::Desk desk;
  Hidden hidden(*desk.port);
  FollowedPort followed(hidden);
  (void)hidden.read();
  auto segments = std::vector(hidden.truth.path.begin(), hidden.truth.path.end());
  for (auto& segment : segments) {
    segment.motion = kernel::signal::Motion::thread;
  }
  followed.offer(std::make_shared<const Route>(std::move(segments)));
  int threads = 0;
  for (int i = 0; i < 500; ++i) {
    const auto frame = followed.read();
    ASSERT_TRUE(frame.has_value());
    if (!frame->path.empty() && hidden.truth.motion != kernel::signal::Motion::idle) {
      EXPECT_EQ(frame->motion, kernel::signal::Motion::thread) << i;
      ++threads;
    }
  }
  EXPECT_GT(threads, 100);
}

/// The share of cycles over the limit with a layer on `port`.
double over_limit(test::Desk& desk, kernel::port::Port& port) {
  desk.layer->set_mode(kernel::machine::Mode::act);
  int over = 0;
  int cutting = 0;
  while (!desk.port->finished()) {
    EXPECT_TRUE(desk.layer->cycle(port, {}).has_value());
    const auto& contour = desk.layer->estimates().contour;
    cutting += 1;
    over += contour && std::abs(contour->error_mm) > desk.machine.contour.limit_mm ? 1 : 0;
  }
  return static_cast<double>(over) / cutting;
}

TEST(FollowedPort, TheLayerGovernsAsOnAMachineThatShowsItsPath) {
  test::Desk shown;
  const double with_path = over_limit(shown, *shown.port);
  test::Desk desk;
  Hidden hidden(*desk.port);
  FollowedPort followed(hidden);
  (void)hidden.read();
  followed.offer(std::make_shared<const Route>(
      std::vector(hidden.truth.path.begin(), hidden.truth.path.end())));
  EXPECT_NEAR(over_limit(desk, followed), with_path, 0.005);
  test::Desk blind;
  Hidden without(*blind.port);
  EXPECT_GT(over_limit(blind, without), with_path + 0.005) << "the path is worth something";
}

TEST(FollowedPort, TakesRoutesFromAnotherThreadWhileItReads) {
  test::Desk desk;
  Hidden hidden(*desk.port);
  FollowedPort followed(hidden);
  (void)hidden.read();
  const std::vector segments(hidden.truth.path.begin(), hidden.truth.path.end());
  std::atomic<bool> ends{false};
  std::thread offers([&] {
    while (!ends.load()) {
      followed.offer(std::make_shared<const Route>(segments));
      followed.offer(nullptr);
    }
  });
  double sum = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const auto frame = followed.read();
    for (const auto& segment : frame->path) {
      sum += segment.length_mm;
    }
  }
  ends.store(true);
  offers.join();
  EXPECT_GE(sum, 0.0);
}

}  // namespace
}  // namespace steadyrest::live
