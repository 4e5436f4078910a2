// SPDX-License-Identifier: Apache-2.0
// `steadyrest run` killed at random moments on a LinuxCNC that cuts circles of 10 mm at F4000, and
// started again at once. Time is the servo thread's own count; no other clock judges anything.
// STEADYREST_KILLS: how often (6); STEADYREST_SEED: other moments.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tests/linuxcnc/live_mill.hpp>
#include <tests/linuxcnc/servo_log.hpp>

#include <steadyrest/kernel/file/testing/own_folder.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/record/record_reader.hpp>
#include <steadyrest/record/run_folder.hpp>
#include <steadyrest/trial/replay/replay.hpp>

namespace steadyrest {
namespace {

using kernel::file::testing::OwnFolder;
using kernel::file::testing::text_of_file;
using linuxcnc_test::servo_log;
using linuxcnc_test::ServoRow;

constexpr double kFeed_mm_s = 4000.0 / 60.0;
/// In servo cycles of 1 ms: late_hold_ms, for so long the ratio stays; then 2 1/s, the slower of
/// feed_rise and spindle_slew in the mill's file.
constexpr double kHold = 1000.0;
constexpr double kLongestReturn = kHold + 500.0 + 5.0;
constexpr double kLongestSpeedReturn = kLongestReturn + 10.0;
constexpr double kRamp = 0.015;             ///< a servo cycle: layer.hal's 15 1/s
constexpr double kAcceleration_mm_s = 2.0;  ///< a servo cycle: 2000 mm/s²
/// A servo cycle. The envelope's 0.05 mm/s are 0.05 µm; a stall is made up with 1 µm at once, which
/// LinuxCNC eases to 0.6 µm a cycle. A jump of the 50 µm would show as 2.5 µm.
constexpr double kOffsetStep_mm = 1e-3;
constexpr double kOffsetBefore_mm = 0.05;
/// A layer that was killed before its record had anything began so many cycles before the first
/// beat that is seen.
constexpr double kMissedBeats = 3.0;
constexpr double kCount_mm = 1e-4 + 1e-9;  ///< of LinuxCNC's offsets, as decimals give it

unsigned long number_from(const char* name, unsigned long otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoul(text, nullptr, 10);
}

/// One kill, as kills.py noted it.
struct Kill {
  double tick = 0.0;    ///< by this servo cycle the process had ended
  bool waited = false;  ///< the next layer came when the feed was the panel's
};

std::vector<Kill> kills_of(const std::string& file) {
  std::ifstream in(file);
  std::vector<Kill> kills;
  for (Kill kill; in >> kill.tick >> kill.waited;) {
    kills.push_back(kill);
  }
  return kills;
}

using At = std::vector<ServoRow>::const_iterator;

At at_tick(const std::vector<ServoRow>& log, double tick) {
  return std::ranges::lower_bound(log, tick, {}, &ServoRow::tick);
}

/// What the servo thread saw of one layer.
struct Life {
  double first_beat = 0.0;
  double last_beat = 0.0;
  double back = 0.0;        ///< cycles from the last beat until the ratio was 1
  double speed_back = 0.0;  ///< and until the feed was the panel's
  double next = 0.0;        ///< and until the next layer's first beat
  bool seen = false;        ///< the log has each of these cycles
};

/// Of the layer that beat in (from, killed]. What it wrote last shows one cycle later.
Life life(const std::vector<ServoRow>& log, double from, double killed) {
  Life out;
  const At before = at_tick(log, from + 1.0);
  if (before == log.end()) {
    return out;
  }
  const At begin = before + 1;
  At last = begin;
  for (At i = begin; i != log.end() && i->tick <= killed + 1.0; ++i) {
    if (i->beat != (i - 1)->beat) {
      out.first_beat = out.first_beat == 0.0 ? i->tick : out.first_beat;
      last = i;
    }
  }
  if (out.first_beat == 0.0) {
    return out;
  }
  out.last_beat = last->tick;
  const auto cycles_until = [&](auto reached) {
    const At found = std::find_if(last, log.end(), reached);
    return found == log.end() ? 1e9 : found->tick - last->tick;
  };
  out.back = cycles_until([](const ServoRow& row) { return row.ratio == 1.0; });
  out.speed_back = cycles_until(
      [](const ServoRow& row) { return std::abs(row.speed_mm_s - kFeed_mm_s) < 1e-6; });
  out.next = cycles_until([&](const ServoRow& row) { return row.beat != last->beat; });
  const At end = at_tick(log, out.last_beat + kLongestSpeedReturn);
  out.seen = end != log.end() && end->tick - out.last_beat == static_cast<double>(end - last);
  return out;
}

/// By how much the ratio rose in the hold after the last beat, before the next layer's first cycle:
/// two of its beats may come in one servo cycle and so be missed.
double risen(const std::vector<ServoRow>& log, double last_beat, double next_cycle) {
  double most = 0.0;
  const At last = at_tick(log, last_beat);
  for (At i = last; i != log.end() && i->tick < std::min(last_beat + kHold, next_cycle); ++i) {
    most = std::max(most, i->ratio - last->ratio);
  }
  return most;
}

double largest_step(const std::vector<ServoRow>& log, At from, double ServoRow::* of, double sign) {
  double most = 0.0;
  for (At i = from + 1; i < log.end(); ++i) {
    const double step = (*i).*of - (*(i - 1)).*of;
    most = std::max(most, (sign == 0.0 ? std::abs(step) : sign * step) / (i->tick - (i - 1)->tick));
  }
  return most;
}

/// The first and the last cycle that a record has; none of an empty one.
struct Cycles {
  double first = 0.0;
  double last = 0.0;
};
std::optional<Cycles> cycles_of(const std::string& file) {
  auto reader = record::RecordReader::open(file);
  if (!reader) {
    ADD_FAILURE() << kernel::outcome::text(reader.error());
    return std::nullopt;
  }
  std::optional<Cycles> cycles;
  record::Sample sample;
  for (;;) {
    const auto more = reader->next(sample);
    if (!more) {
      ADD_FAILURE() << kernel::outcome::text(more.error());
    }
    if (!more || !*more) {
      return cycles;
    }
    const auto cycle = static_cast<double>(sample.frame.cycle);
    cycles = {.first = cycles ? cycles->first : cycle, .last = cycle};
  }
}

/// Cycles that the record of a killed layer lacks at its end.
double expect_whole(const std::string& file, const Life& life,
                    const kernel::machine::Machine& machine) {
  const auto replayed = trial::replay::replay(file, machine);
  if (!replayed) {
    ADD_FAILURE() << kernel::outcome::text(replayed.error());
    return 0.0;
  }
  EXPECT_FALSE(replayed->first_difference.has_value()) << file;
  const auto cycles = cycles_of(file);
  return life.last_beat - (cycles ? cycles->last : life.first_beat - 1.0);
}

/// The mill of the examples, on a running LinuxCNC; enough circles for all kills.
void write_inputs(const OwnFolder& folder, unsigned long kills) {
  linuxcnc_test::write_mill(folder.at("machine.toml"));
  std::ofstream(folder.at("circles.ngc"))
      << "G21 G90 G94 G17 G61\nM52 P1 S6000 M3\nG0 X10 Y-30 Z0\nG1 Y0 F4000\nG3 X10 Y0 I-10 J0 P"
      << 200 + 10 * kills << '\n';
}

void expect_no_jump(const std::vector<ServoRow>& log) {
  // From here on the circle is cut and a layer is there.
  const At first = std::ranges::find(log, 1.0, &ServoRow::alive);
  ASSERT_NE(first, log.end());
  EXPECT_NEAR(first->z_mm, kOffsetBefore_mm, kCount_mm);
  EXPECT_NEAR(log.back().z_mm, 0.0, kCount_mm);
  const double up = largest_step(log, first, &ServoRow::ratio, 1.0);
  const double speed = largest_step(log, first, &ServoRow::speed_mm_s, 0.0);
  const double offset = largest_step(log, first, &ServoRow::z_mm, 0.0);
  EXPECT_LE(up, kRamp + 1e-9);
  EXPECT_LE(speed, kAcceleration_mm_s + 1e-6);
  EXPECT_LE(offset, kOffsetStep_mm);
  std::printf("largest step a cycle: ratio up %.4f, speed %.3f mm/s, offset %.3f um\n", up, speed,
              1e3 * offset);
}

struct Figures {
  std::vector<double> back;
  std::vector<double> speed_back;
  std::vector<double> lost;
};

Figures expect_each_let_go(const std::vector<ServoRow>& log, const std::vector<Kill>& killed,
                           const OwnFolder& folder) {
  Figures out;
  const auto machine = passport::read(folder.at("machine.toml"));
  const auto files = record::run_files(folder.path());
  std::vector<std::string> runs;
  for (const auto& file : files.value()) {
    if (file.rotates) {
      runs.push_back(file.file);
    }
  }
  EXPECT_EQ(runs.size(), killed.size() + 1) << "a record for each layer";
  for (std::size_t i = 0; i < std::min(killed.size(), runs.size()); ++i) {
    const Life of = life(log, i == 0 ? log.front().tick : killed[i - 1].tick, killed[i].tick);
    EXPECT_GT(of.last_beat, 0.0) << i;
    const std::string where = "kill " + std::to_string(i);
    EXPECT_TRUE(!killed[i].waited || of.next > of.back) << where;
    const auto next = i + 1 < runs.size() ? cycles_of(runs[i + 1]) : std::nullopt;
    const double begun = next ? next->first : of.last_beat + of.next - kMissedBeats;
    EXPECT_LE(risen(log, of.last_beat, begun), 1e-9) << where << ": the feed rises in the cut";
    if (of.seen && of.next > std::min(of.back, kLongestReturn)) {
      EXPECT_LE(of.back, kLongestReturn) << where;
      EXPECT_GE(of.back, kHold) << where;
      out.back.push_back(of.back);
    }
    if (of.seen && of.next > std::min(of.speed_back, kLongestSpeedReturn)) {
      EXPECT_LE(of.speed_back, kLongestSpeedReturn) << where;
      out.speed_back.push_back(of.speed_back);
    }
    out.lost.push_back(expect_whole(runs[i], of, machine.value()));
  }
  expect_whole(runs.back(), {}, machine.value());
  return out;
}

void show(const char* what, std::vector<double> values) {
  std::ranges::sort(values);
  if (!values.empty()) {
    std::printf("%s: median %.0f, at most %.0f cycles (%zu)\n", what, values[values.size() / 2],
                values.back(), values.size());
  }
}

TEST(Kills, EachLeavesTheFeedToThePanelAndTheNextLayerTakesOver) {
  const OwnFolder folder;
  const unsigned long kills = number_from("STEADYREST_KILLS", 6);
  write_inputs(folder, kills);
  const int status = linuxcnc_test::run_on_linuxcnc(
      folder, {.script = "kills.py",
               .program = "circles.ngc",
               .hal = "lag.hal layer.hal layer_offsets.hal lag_log.hal",
               .arguments = std::to_string(kills) + " " +
                            std::to_string(number_from("STEADYREST_SEED", 1))});
  if (status == linuxcnc_test::kCannotRun) {
    GTEST_SKIP() << "LinuxCNC cannot run here";
  }
  ASSERT_EQ(status, 0);
  const auto log = servo_log(folder.at("log"));
  const auto killed = kills_of(folder.at("kills"));
  ASSERT_EQ(killed.size(), kills);
  ASSERT_GT(log.size(), 1000U);
  expect_no_jump(log);
  const Figures figures = expect_each_let_go(log, killed, folder);
  EXPECT_FALSE(figures.back.empty());
  show("ratio back at 1", figures.back);
  show("feed back at the panel's", figures.speed_back);
  show("not in the record", figures.lost);
  std::printf(
      "%lu of %lu were followed by the next layer before that\nservo cycles that the sampler lost: "
      "%.0f\n",
      kills - figures.back.size(), kills,
      log.back().tick - log.front().tick + 1.0 - static_cast<double>(log.size()));
}

}  // namespace
}  // namespace steadyrest
