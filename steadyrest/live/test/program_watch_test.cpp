// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <condition_variable>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/live/path/program_watch.hpp>
#include <steadyrest/live/test/desk.hpp>

namespace steadyrest::live {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::outcome::Result;
using nc::follow::Place;
using testing::HasSubstr;

/// A control that says what the test tells it; each state is looked at before the next is told.
class FakeControl {
 public:
  [[nodiscard]] ProgramWatch::Source source() {
    return [this](double wait_s) { return wait(wait_s); };
  }
  /// Returns when the watch has done with it.
  void tell(Result<std::optional<LoadedProgram>> state) {
    std::unique_lock lock(mutex_);
    state_ = std::move(state);
    waiting_ = false;
    changed_.notify_all();
    changed_.wait(lock, [this] { return waiting_ && !state_; });
  }

 private:
  Result<std::optional<LoadedProgram>> wait(double wait_s) {
    std::unique_lock lock(mutex_);
    waiting_ = true;
    changed_.notify_all();
    changed_.wait_for(lock, std::chrono::duration<double>(wait_s),
                      [this] { return state_.has_value(); });
    if (!state_) {
      return std::optional<LoadedProgram>();
    }
    auto state = std::move(*state_);
    state_.reset();
    waiting_ = false;
    return state;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Result<std::optional<LoadedProgram>>> state_;
  bool waiting_ = false;
};

struct Watched {
  Watched()
      : watch(port, desk.machine, control.source(),
              [this](const std::string& words) { warnings.push_back(words); }) {}

  LoadedProgram loaded(bool stopped = true) const {
    LoadedProgram program;
    program.file = folder.at("part.mpf");
    program.start.dialect = desk.machine.control.dialect;
    program.start.axes = "XYZ";
    program.stopped = stopped;
    return program;
  }
  void write(const std::string& text) const { std::ofstream(folder.at("part.mpf")) << text; }

  std::vector<std::string> warnings;  ///< read after FakeControl::tell()
  OwnFolder folder;
  test::Desk desk;
  FollowedPort port{*desk.port};
  FakeControl control;
  ProgramWatch watch;
};

const std::string kPart = "G17 G90 G94 G71\nG0 X10 Y0\nG3 X10 Y0 I-10 J0 F4000\nM30\n";

TEST(ProgramWatch, PlansWhatTheControlHasLoaded) {
  Watched watched;
  watched.control.tell(std::optional<LoadedProgram>(LoadedProgram{}));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("no program"));
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().words, "");
  EXPECT_EQ(watched.watch.status().segments, 2U);
  EXPECT_EQ(watched.port.read()->path.size(), 0U) << "not found yet";
  EXPECT_NE(watched.port.place(), Place::no_route);
}

// The same circle, commanded larger by what the axes lag.
const std::string kCorrected =
    ";STEADYREST head made --changes predistort --tube-mm 0.5 --sum 6fa7c094\n"
    "G17 G90 G94 G71\nG0 X10 Y0\n;STEADYREST was 3 G3 X10 Y0 I-10 J0 F4000\n"
    "G1 X10.1 F4000 ;STEADYREST new\nG3 X10.1 Y0 I-10.1 J0 ;STEADYREST new\n"
    "G1 X10 ;STEADYREST new\nM30\n";

TEST(ProgramWatch, KnowsTheOriginalOfATextThatCorrectsThePath) {
  Watched watched;
  watched.write(kCorrected);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().words, "");
  EXPECT_GT(watched.watch.status().segments, 0U);
  EXPECT_TRUE(watched.warnings.empty());
}

TEST(ProgramWatch, SaysWhyTheOriginalIsNotKnown) {
  Watched watched;
  std::string damaged = kCorrected;
  damaged.replace(damaged.find("was 3"), 5, "was 4");
  watched.write(damaged);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_GT(watched.watch.status().segments, 0U);
  EXPECT_THAT(watched.watch.status().words, HasSubstr("the layer stays out of the contour"));
  ASSERT_EQ(watched.warnings.size(), 1U);
  EXPECT_THAT(watched.warnings[0], HasSubstr("fewer new lines than it says"));
  EXPECT_TRUE(watched.port.read()->original_unknown);
}

// Nothing is planned, and yet no guess may follow the text's shift as an error.
TEST(ProgramWatch, KnowsWithoutAPlanThatTheTextCorrectsThePath) {
  Watched watched;
  watched.write(kCorrected + "G999\n");
  auto program = watched.loaded();
  program.text_is_file = false;
  watched.control.tell(std::optional(program));
  EXPECT_EQ(watched.watch.status().segments, 0U);
  EXPECT_TRUE(watched.port.read()->original_unknown);
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_FALSE(watched.port.read()->original_unknown);
}

// The file has the name that it had without marks.
TEST(ProgramWatch, ReadsTheMarksOfANewTextThatCannotBePlanned) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  std::string refused = kCorrected;
  watched.write(refused.insert(refused.find("M30"), "G999\n"));
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 0U);
  EXPECT_TRUE(watched.port.read()->original_unknown);
}

TEST(ProgramWatch, SaysWhyAProgramIsNotRead) {
  Watched watched;
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("part.mpf"));
  watched.write("G0 X10\nG999\nM30\n");
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("part.mpf:2"));
  EXPECT_EQ(watched.warnings.size(), 2U) << "each is told once";
  EXPECT_EQ(watched.watch.status().segments, 0U);
  // Mended, it is read again.
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, WithdrawsWhereAnOffsetChangedBetweenPlanAndStart) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  watched.control.tell(std::optional(watched.loaded(false)));
  const auto found = [&] {
    int frames = 0;
    for (int i = 0; i < 200; ++i) {
      frames += watched.port.read()->path.empty() ? 0 : 1;
    }
    return frames;
  };
  // The way to the first point is not: where it began was not seen.
  EXPECT_GT(found(), 120);
  auto shifted = watched.loaded(false);
  shifted.start.work_offset[0][0] = 5.0;
  watched.control.tell(std::optional(shifted));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("offsets, tools or modes"));
  EXPECT_EQ(found(), 0);
  // Another position of the axes is left to the locator.
  shifted = watched.loaded(false);
  shifted.stopped = true;
  watched.control.tell(std::optional(shifted));
  EXPECT_EQ(watched.watch.status().segments, 2U);
  shifted.stopped = false;
  shifted.start.start[0] = 3.0;
  watched.control.tell(std::optional(shifted));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, SeesASubprogramThatIsReplaced) {
  Watched watched;
  const auto write_sub = [&](const std::string& text) {
    std::ofstream(watched.folder.at("side.spf")) << text;
  };
  write_sub("G1 X20 F1000\nM17\n");
  watched.write("G17 G90 G94 G71\nG0 X0 Y0\nSIDE\nM30\n");
  auto loaded = watched.loaded();
  loaded.start.subprogram_folders = {watched.folder.path().string()};
  watched.control.tell(std::optional(loaded));
  const std::size_t before = watched.watch.status().segments;
  ASSERT_GT(before, 0U) << watched.watch.status().words;
  write_sub("G1 X20 F1000\nY20\nM17\n");
  watched.control.tell(std::optional(loaded));
  EXPECT_EQ(watched.watch.status().segments, before + 1) << watched.watch.status().words;
  loaded.stopped = false;
  watched.control.tell(std::optional(loaded));
  write_sub("G1 X20 F1000\nY20\nX0\nM17\n");
  watched.control.tell(std::optional(loaded));
  EXPECT_EQ(watched.watch.status().segments, 0U);
}

TEST(ProgramWatch, WithdrawsFromAProgramThatIsEditedWhileItRuns) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  watched.control.tell(std::optional(watched.loaded(false)));
  EXPECT_EQ(watched.watch.status().segments, 2U);
  watched.write(kPart + "; a later thought\n");
  watched.control.tell(std::optional(watched.loaded(false)));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("has changed while it runs"));
  (void)watched.port.read();
  EXPECT_EQ(watched.port.place(), Place::no_route);
  // Back to the old text does not help: the control may have read either.
  watched.control.tell(std::optional(watched.loaded(false)));
  EXPECT_EQ(watched.watch.status().segments, 0U);
  watched.control.tell(std::optional(watched.loaded(true)));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, HasNoPathWhileTheControlHoldsAnotherTextThanTheFile) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
  auto replaced = watched.loaded();
  replaced.text_is_file = false;
  for (const bool stopped : {true, false}) {
    replaced.stopped = stopped;
    watched.control.tell(std::optional(replaced));
    EXPECT_EQ(watched.watch.status().segments, 0U);
    EXPECT_THAT(watched.watch.status().words, HasSubstr("since the control opened it"));
    (void)watched.port.read();
    EXPECT_EQ(watched.port.place(), Place::no_route);
  }
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, WithdrawsWhenTheControlIsNoLongerHeard) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  watched.control.tell(kernel::outcome::refuse("the channel is gone", "start it"));
  EXPECT_THAT(watched.watch.status().words, HasSubstr("the channel is gone"));
  (void)watched.port.read();
  EXPECT_EQ(watched.port.place(), Place::no_route);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, ALostStatusBringsNoPathToAProgramThatWasEditedWhileItRan) {
  Watched watched;
  const auto segments_while_it_runs = [&] {
    watched.control.tell(std::optional(watched.loaded(false)));
    return watched.watch.status().segments;
  };
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(segments_while_it_runs(), 2U);
  watched.control.tell(kernel::outcome::refuse("the channel is gone", "start it"));
  EXPECT_EQ(segments_while_it_runs(), 2U) << "the same program goes on";
  watched.control.tell(kernel::outcome::refuse("the channel is gone", "start it"));
  watched.write(kPart + "; a later thought\n");
  EXPECT_EQ(segments_while_it_runs(), 0U) << "edited unheard";
  watched.control.tell(kernel::outcome::refuse("the channel is gone", "start it"));
  EXPECT_EQ(segments_while_it_runs(), 0U);
  EXPECT_THAT(watched.watch.status().words, HasSubstr("has changed while it runs"));
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, ATextThatWasAnotherWhileItRanHasNoPathUntilItHasEnded) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(std::optional(watched.loaded()));
  auto running = watched.loaded(false);
  running.text_is_file = false;
  watched.control.tell(std::optional(running));
  running.text_is_file = true;
  for (int i = 0; i < 2; ++i) {
    watched.control.tell(std::optional(running));
    EXPECT_EQ(watched.watch.status().segments, 0U);
    EXPECT_THAT(watched.watch.status().words, HasSubstr("until it has ended"));
  }
  watched.control.tell(std::optional(watched.loaded()));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

TEST(ProgramWatch, PlansAProgramThatRunsWhenTheWatchBegins) {
  Watched watched;
  watched.write(kPart);
  watched.control.tell(kernel::outcome::refuse("not yet", "wait"));
  watched.control.tell(std::optional(watched.loaded(false)));
  EXPECT_EQ(watched.watch.status().segments, 2U);
}

}  // namespace
}  // namespace steadyrest::live
