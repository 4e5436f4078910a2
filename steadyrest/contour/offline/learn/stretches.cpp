// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>

#include <steadyrest/contour/offline/learn/local_fit.hpp>
#include <steadyrest/contour/offline/learn/stretches.hpp>

namespace steadyrest::contour::offline {
namespace {

using kernel::signal::Point;

constexpr std::size_t kFewest = 4;    ///< samples of a stretch
constexpr double kForward_mm = 1e-6;  ///< that a foot must move on
constexpr double kFade = 3.0;         ///< σ

class Stretches {
 public:
  Stretches(const std::vector<ErrorSample>& samples, const SharpCorners& corners,
            const std::array<double, 3>& lags_s, double sigma_s)
      : samples_(samples), corners_(corners), lags_s_(lags_s), sigma_s_(sigma_s) {}

  std::vector<Learnt::Stretch> take() {
    double done_mm = -1.0;  // what is learnt never goes back
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!samples_[i].valid) {
        finish();
        continue;
      }
      const double foot = samples_[i].foot_mm;
      if (foot <= done_mm + kForward_mm) {
        continue;
      }
      if (!members_.empty() && corners_.between(samples_[members_.back()].foot_mm, foot)) {
        finish();
      }
      members_.push_back(i);
      done_mm = foot;
    }
    finish();
    return std::move(out_);
  }

 private:
  void finish() {
    if (members_.size() >= kFewest) {
      fit();
    }
    members_.clear();
  }

  void fit() {
    std::vector<double> time;
    std::vector<Point> off;
    for (const std::size_t i : members_) {
      time.push_back(samples_[i].time_s);
      off.push_back(samples_[i].off_mm);
    }
    const std::size_t first = members_.front();
    const std::size_t last = members_.back();
    const bool fades_in = first > 0 && samples_[first - 1].fades;
    const bool fades_out = last + 1 < samples_.size() && samples_[last + 1].fades;
    const double fade_s = kFade * sigma_s_;
    Learnt::Stretch stretch;
    for (std::size_t j = 0; j < members_.size(); ++j) {
      const LocalLine line = local_line(time, off, j, sigma_s_);
      Learnt::Knot knot{.at_mm = samples_[members_[j]].foot_mm, .unknown_mm = line.value};
      for (std::size_t axis = 0; axis < lags_s_.size(); ++axis) {
        knot.shift_mm[axis] = line.value[axis] + lags_s_[axis] * line.slope_1_s[axis];
      }
      knot.weight = std::min({1.0, fades_in ? (time[j] - time.front()) / fade_s : 1.0,
                              fades_out ? (time.back() - time[j]) / fade_s : 1.0});
      stretch.knots.push_back(knot);
    }
    // Up to the corner that ends it.
    const double front = stretch.knots.front().at_mm;
    const double back = stretch.knots.back().at_mm;
    stretch.from_mm = fades_in ? front : corners_.before(front);
    stretch.to_mm = fades_out ? back : corners_.after(back);
    out_.push_back(std::move(stretch));
  }

  const std::vector<ErrorSample>& samples_;
  const SharpCorners& corners_;
  const std::array<double, 3>& lags_s_;
  double sigma_s_;
  std::vector<std::size_t> members_;
  std::vector<Learnt::Stretch> out_;
};

}  // namespace

std::vector<Learnt::Stretch> stretches_of(const std::vector<ErrorSample>& samples,
                                          const SharpCorners& corners,
                                          const std::array<double, 3>& lags_s, double sigma_s) {
  return Stretches(samples, corners, lags_s, sigma_s).take();
}

}  // namespace steadyrest::contour::offline
