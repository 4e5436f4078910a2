// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <string_view>

namespace steadyrest::contour::offline {

/// How far the work is, in runs of the model: each phase has a number of them at most, and the next
/// begins where they end. Never falls; what is repeated beyond the runs expected stays at the most.
class PhaseProgress {
 public:
  /// `runs`: of all phases together.
  PhaseProgress(const std::function<void(double share, std::string_view what)>& report, int runs)
      : report_(report), runs_(runs) {}

  void phase(std::string_view what, int runs) {
    what_ = what;
    done_ = end_;
    end_ += runs;
    run(0.0);
  }
  /// The share of the present run.
  void run(double share) const {
    report_(std::min(kMost, (done_ + std::clamp(share, 0.0, 1.0)) / runs_), what_);
  }
  void ran() { done_ = std::min(done_ + 1, end_); }

 private:
  static constexpr double kMost = 0.99;

  const std::function<void(double share, std::string_view what)>& report_;
  int runs_;
  int done_ = 0;
  int end_ = 0;
  std::string_view what_;
};

}  // namespace steadyrest::contour::offline
