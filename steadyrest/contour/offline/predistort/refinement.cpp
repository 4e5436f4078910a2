// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <steadyrest/contour/offline/learn/sharp_corners.hpp>
#include <steadyrest/contour/offline/predistort/refinement.hpp>
#include <steadyrest/math/geometry/path_pairing.hpp>

namespace steadyrest::contour::offline {
namespace {

constexpr double kLags = 3.0;

}  // namespace

std::vector<Learnt::Stretch> refinement(std::vector<ErrorSample> errors,
                                        const nc::plan::PlannedPath& path,
                                        const std::vector<SegmentUse>& use,
                                        const ServoModels& model, double share) {
  for (ErrorSample& error : errors) {
    error.valid = error.valid && use[math::geometry::segment_at(path.segments, error.foot_mm)].free;
  }
  const std::array<double, 3> lags_s = first_lags_s(model);
  auto out =
      stretches_of(errors, sharp_corners(path.segments), lags_s, kLags * std::ranges::max(lags_s));
  for (Learnt::Stretch& stretch : out) {
    for (Learnt::Knot& knot : stretch.knots) {
      knot.weight *= share;
    }
  }
  return out;
}

}  // namespace steadyrest::contour::offline
