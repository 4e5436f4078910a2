// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <steadyrest/adapters/linuxcnc/config/layer_text.hpp>
#include <steadyrest/adapters/linuxcnc/config/text_lines.hpp>
#include <steadyrest/kernel/file/testing/own_folder.hpp>

namespace steadyrest::adapters::linuxcnc::config {
namespace {

using testing::HasSubstr;
using testing::Not;

LayerHal three_axes() {
  LayerHal layer;
  layer.axes = {{'X', 0, false}, {'Y', 1, false}, {'Z', 2, false}};
  return layer;
}

/// The commands of a HAL text in any order, numbers as numbers.
std::multiset<std::string> commands(const std::string& text) {
  std::multiset<std::string> out;
  for (const std::string& line : lines_of(text)) {
    const auto words = words_of(std::string_view(line).substr(0, line.find('#')));
    std::string command;
    for (const std::string& word : words) {
      double number = 0.0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      const bool is_number = error == std::errc{} && end == word.data() + word.size();
      command += (is_number ? std::to_string(number * 1e6) : word) + " ";
    }
    if (!command.empty()) {
      out.insert(command);
    }
  }
  return out;
}

/// Commands that are in one of the two only.
std::vector<std::string> difference(const std::string& one, const std::string& other) {
  const auto a = commands(one);
  const auto b = commands(other);
  std::vector<std::string> out;
  std::ranges::set_symmetric_difference(a, b, std::back_inserter(out));
  return out;
}

std::string shipped(const std::string& name) {
  return kernel::file::testing::text_of_file(
      STEADYREST_SOURCE_DIR "/steadyrest/adapters/linuxcnc/" + name);
}

TEST(LayerText, OfThreeAxesDoesWhatLayerHalDoes) {
  EXPECT_THAT(difference(shipped_layer_hal(), shipped("layer.hal")), testing::IsEmpty());
}

TEST(LayerText, OfThreeAxesHasTheOffsetsOfLayerOffsetsHal) {
  EXPECT_THAT(difference(shipped_offsets_hal(), shipped("layer_offsets.hal")), testing::IsEmpty());
}

TEST(LayerText, HasAColumnOfTheRightTypeForEachSample) {
  const std::string text = layer_text(three_axes());
  EXPECT_THAT(text,
              HasSubstr("loadrt sampler depth=4000,4000 cfg=fssfffffbfffffbbbbb,fffffffffffff\n"));
  EXPECT_THAT(text, HasSubstr("net layer-is-auto halui.mode.is-auto => sampler.0.pin.15\n"));
  EXPECT_THAT(text, HasSubstr("net layer-is-paused halui.program.is-paused => sampler.0.pin.17\n"));
  EXPECT_THAT(text, HasSubstr("net layer-x-command joint.0.pos-cmd => sampler.1.pin.1\n"));
  EXPECT_THAT(text, HasSubstr("net layer-z-eoffset axis.z.eoffset => sampler.1.pin.12\n"));
}

// A lathe has no Y, its joint 1 is Z; a fifth axis opens a second channel.
TEST(LayerText, FollowsTheAxesOfTheMachineFile) {
  LayerHal layer;
  layer.axes = {
      {'X', 0, false}, {'Y', std::nullopt, false}, {'Z', 1, false}, {'A', 2, true}, {'C', 3, true}};
  const std::string text = layer_text(layer);
  EXPECT_THAT(text, HasSubstr("depth=4000,4000,4000"));
  EXPECT_THAT(text, HasSubstr(",fffffffffffffffff,fffff\n"));
  EXPECT_THAT(text, HasSubstr("net layer-z-command joint.1.pos-cmd => sampler.1.pin.9\n"));
  EXPECT_THAT(text, HasSubstr("net layer-c-eoffset axis.c.eoffset => sampler.2.pin.4\n"));
  EXPECT_THAT(text, HasSubstr("sampler.1.pin.0 sampler.2.pin.0\n"));
  EXPECT_THAT(text, HasSubstr("addf sampler.2 servo-thread\n"));
  EXPECT_THAT(text, Not(HasSubstr("layer-y-")));
  // The process connects a pin for each axis; those without an offset lead nowhere.
  const std::string offsets = offsets_text(layer);
  EXPECT_THAT(offsets, HasSubstr("names=layer.counts-x,layer.counts-z\n"));
  EXPECT_THAT(offsets, HasSubstr("net layer-offset-2 => layer.offset-z.in0\n"));
  for (const char* index : {"1", "3", "4"}) {
    EXPECT_THAT(offsets, HasSubstr(std::string("newsig layer-offset-") + index + " float\n"));
  }
}

TEST(LayerText, UsesWhatTheMachineHas) {
  LayerHal layer = three_axes();
  layer.offset_components = false;
  layer.loaded = {"mux2"};
  layer.instance = {{"layer.feed-choice", "mux2.2"}, {"layer.spindle-choice", "mux2.3"}};
  layer.signal = {{"motion.current-vel", "speed"}, {"spindle.0.speed-in", "measured"}};
  layer.drives = {"speed-out", "speed-out-abs"};
  const std::string text = layer_text(layer);
  EXPECT_THAT(text, Not(HasSubstr("loadrt mux2")));
  EXPECT_THAT(text, HasSubstr("addf mux2.2 servo-thread 5\n"));
  EXPECT_THAT(text, HasSubstr("net layer-feed => mux2.2.in1\n"));
  EXPECT_THAT(text, HasSubstr("net layer-held layer.held.out => mux2.2.sel mux2.3.sel"));
  EXPECT_THAT(text, HasSubstr("net speed motion.current-vel => sampler.0.pin.3\n"));
  EXPECT_THAT(text, HasSubstr("net measured => sampler.0.pin.7\n"));
  EXPECT_THAT(text, HasSubstr("loadrt mult2 names=layer.drive,layer.drive-rpm,layer.drive-abs\n"));
  EXPECT_THAT(text,
              HasSubstr("net layer-spindle-out spindle.0.speed-out => layer.drive-rpm.in0\n"));
  EXPECT_THAT(text, HasSubstr("net layer-drive-rpm layer.drive-rpm.out\n"));
  EXPECT_THAT(text, Not(HasSubstr("layer.offset")));
}

}  // namespace
}  // namespace steadyrest::adapters::linuxcnc::config
