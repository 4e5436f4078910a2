// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <steadyrest/nc/interpret/motion/motion.hpp>
#include <steadyrest/nc/interpret/test/moves.hpp>

// No dialect has both G9 and cutter compensation; here the stages get both.
namespace steadyrest::nc::interpret {
namespace {

class MotionStage : public ::testing::Test {
 protected:
  MotionStage() {
    parameters_.bind(control_.state, control_.config);
    control_.state.feed_mm_s = 10.0;
    block_.reset(1);
    block_.push({.letter = 'G', .name = {}, .text = "G1"});
  }

  Step step() {
    cutter_.send_to(kept_);
    Step step{};
    step.reset(block_);
    return step;
  }
  void cutter(int code) {
    Step on = step();
    on.g[static_cast<std::size_t>(GGroup::cutter)] = static_cast<std::int16_t>(code);
    on.set('D', 4.0);
    ASSERT_TRUE(cutter_.set(on));
  }
  bool straight(double x, double y, bool exact_stop) {
    Step line = step();
    line.moves_by = g::kLinear;
    line.exact_stop = exact_stop;
    line.set('X', x);
    line.set('Y', y);
    return motion_.straight(line);
  }

  Control control_{Config{}};
  Parameters parameters_;
  MoveOutput out_{control_.state};
  CutterStage cutter_{control_, out_};
  Corners corners_{control_, out_};
  Motion motion_{control_, out_, cutter_, corners_, parameters_};
  read::Block block_;
  Kept kept_;
};

std::vector<PathMode> modes_of(const std::vector<Move>& moves) {
  std::vector<PathMode> out;
  out.reserve(moves.size());
  for (const Move& move : moves) {
    out.push_back(move.path_mode);
  }
  return out;
}

const std::vector<PathMode> kSecondStops = {PathMode::continuous, PathMode::exact_stop,
                                            PathMode::continuous, PathMode::continuous};

TEST_F(MotionStage, G9StopsAtTheEndOfItsBlockAlone) {
  EXPECT_TRUE(straight(10.0, 0.0, false) && straight(20.0, 0.0, true) &&
              straight(20.0, 20.0, false) && straight(0.0, 20.0, false));
  EXPECT_EQ(modes_of(kept_.moves), kSecondStops);
}

// The compensation holds the move back until the next one is known.
TEST_F(MotionStage, G9StopsAtTheEndOfItsCompensatedBlockAlone) {
  cutter(g::kCutterLeftBy);
  EXPECT_TRUE(straight(10.0, 0.0, false) && straight(20.0, 0.0, true) &&
              straight(20.0, 20.0, false) && straight(0.0, 20.0, false));
  cutter(g::kCutterOff);
  EXPECT_EQ(modes_of(kept_.moves), kSecondStops);
  EXPECT_EQ(control_.state.path_mode, PathMode::continuous);
}

TEST_F(MotionStage, G9EndsWithABlockThatIsRefused) {
  cutter(g::kCutterLeftBy);
  EXPECT_FALSE(straight(1.0, 0.0, true));  // not longer than the tool's radius
  EXPECT_EQ(control_.state.path_mode, PathMode::continuous);
}

}  // namespace
}  // namespace steadyrest::nc::interpret
