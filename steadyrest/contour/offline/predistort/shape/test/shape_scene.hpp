// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <steadyrest/contour/offline/predistort/shape/command_shape.hpp>
#include <steadyrest/contour/online/test/paths.hpp>

namespace steadyrest::contour::offline::test {

/// A path of free blocks without stops, one segment for each line, and a control that
/// runs it at one speed.
class ShapeScene {
 public:
  static constexpr double kFeed_mm_s = 40.0;
  static constexpr double kGain_1_s = 50.0;
  static constexpr double kLag_s = 1.0 / kGain_1_s;
  static constexpr double kLead_mm = kFeed_mm_s * kLag_s;  ///< of the command on a line

  explicit ShapeScene(const std::vector<kernel::signal::PathSegment>& segments) {
    path.segments = segments;
    use.assign(segments.size(), {.free = true, .stops = false});
    for (std::size_t i = 0; i < segments.size(); ++i) {
      path.segments[i].line = static_cast<std::uint32_t>(i + 1);
    }
    model.fill({.gain_1_s = kGain_1_s});
  }

  [[nodiscard]] std::vector<Piece> pieces() const {
    const ServoInverse inverse(model);
    CommandSpeed speed;
    speed.add(0.0, kFeed_mm_s);
    speed.add(1e4, kFeed_mm_s);
    const ToolMotion motion(inverse, path, speed);
    return CommandShape(path, use, inverse, motion, learnt, config).pieces();
  }
  /// The pieces of one block.
  [[nodiscard]] std::vector<Piece> pieces_of(std::uint32_t line) const {
    std::vector<Piece> out = pieces();
    std::erase_if(out, [line](const Piece& piece) { return piece.segment.line != line; });
    return out;
  }

  /// 20 mm or more from both ends of the path.
  [[nodiscard]] bool is_inside(const Piece& piece) const {
    const auto& last = path.segments.back();
    return piece.progress_start_mm > 20.0 &&
           piece.progress_end_mm < last.position_mm + last.length_mm - 20.0;
  }

  static online::test::PathMaker from(const kernel::signal::Point& start) {
    return online::test::PathMaker(start, kFeed_mm_s);
  }

  nc::plan::PlannedPath path;
  std::vector<SegmentUse> use;
  ServoModels model;
  Learnt learnt;
  ShapeConfig config;
};

}  // namespace steadyrest::contour::offline::test
