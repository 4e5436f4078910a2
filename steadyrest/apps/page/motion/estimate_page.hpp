// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <steadyrest/apps/page/shared/page.hpp>
#include <steadyrest/motion/online/estimator/estimator.hpp>

namespace steadyrest::apps::page {

/// Reduces the estimates of a log of any length to a picture of bounded size: stretches of equally
/// many ticks, each with the lowest and the highest value and the widest bound.
class EstimateCourse {
 public:
  /// `most` stretches, at least 2.
  explicit EstimateCourse(std::size_t most = 4000);

  void add(const motion::online::Estimate& estimate);

  /// Ticks in each stretch but the last.
  [[nodiscard]] std::size_t ticks_each() const noexcept { return each_; }
  /// `t_s`, `position_mm`, `velocity_mm_s`, `acceleration_mm_s2`; the latter three as `low`, `high`
  /// and `bound`, null where the estimator gave none somewhere in the stretch.
  void put(Json& page) const;

 private:
  struct Range {
    double low = 0.0;
    double high = 0.0;
    double bound = 0.0;

    void widen(const Range& other);
  };
  struct Stretch {
    double t_s = 0.0;
    Range position;
    Range velocity;
    Range acceleration;

    void join(const Stretch& later);
  };

  [[nodiscard]] Json column(Range Stretch::* quantity) const;

  std::size_t most_;
  std::size_t each_ = 1;
  std::size_t in_last_ = 0;
  std::vector<Stretch> stretches_;
};

struct EstimatePage {
  std::string log;
  double count_mm = 0.0;
};

/// The page of `motion estimate`. Schema: web/src/motion/data.ts.
[[nodiscard]] Json estimate_page(const Json& answer, const EstimatePage& page,
                                 const EstimateCourse& course);

}  // namespace steadyrest::apps::page
