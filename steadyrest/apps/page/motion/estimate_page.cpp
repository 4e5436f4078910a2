// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/apps/page/motion/estimate_page.hpp>
#include <steadyrest/apps/page/shared/json_numbers.hpp>

// A log of any length as a picture of bounded size. When the stretches are used up, neighbours join
// in pairs and each then holds twice as many ticks, so no second pass over the log is needed.
namespace steadyrest::apps::page {

using motion::online::Estimate;

/// Extremes and the widest bound survive every joining: no peak is lost.
void EstimateCourse::Range::widen(const Range& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  bound = std::max(bound, other.bound);
}

void EstimateCourse::Stretch::join(const Stretch& later) {
  position.widen(later.position);
  velocity.widen(later.velocity);
  acceleration.widen(later.acceleration);
}

EstimateCourse::EstimateCourse(std::size_t most) : most_(std::max<std::size_t>(most, 2)) {
  stretches_.reserve(most_);
}

void EstimateCourse::add(const Estimate& e) {
  const auto one = [](double value, double bound) { return Range{value, value, bound}; };
  const Stretch tick{.t_s = e.t_s,
                     .position = one(e.position_mm, e.position_bound_mm),
                     .velocity = one(e.velocity_mm_s, e.velocity_bound_mm_s),
                     .acceleration = one(e.acceleration_mm_s2, e.acceleration_bound_mm_s2)};
  // Full and a new stretch is due: join pairs, so half the places are free again.
  if (in_last_ == 0 && stretches_.size() == most_) {
    for (std::size_t i = 0; 2 * i < stretches_.size(); ++i) {
      stretches_[i] = stretches_[2 * i];
      if (2 * i + 1 < stretches_.size()) {
        stretches_[i].join(stretches_[2 * i + 1]);
      }
    }
    // With an odd number the last stretch is half full.
    in_last_ = stretches_.size() % 2 == 0 ? 0 : each_;
    stretches_.resize((stretches_.size() + 1) / 2);
    each_ *= 2;
  }
  if (in_last_ == 0) {
    stretches_.push_back(tick);
  } else {
    stretches_.back().join(tick);
  }
  in_last_ = (in_last_ + 1) % each_;
}

/// low and high are drawn as a band, bound as a wider one.
Json EstimateCourse::column(Range Stretch::* quantity) const {
  std::vector<double> low;
  std::vector<double> high;
  std::vector<double> bound;
  for (const Stretch& stretch : stretches_) {
    low.push_back((stretch.*quantity).low);
    high.push_back((stretch.*quantity).high);
    bound.push_back((stretch.*quantity).bound);
  }
  return {
      {"low", short_numbers(low)}, {"high", short_numbers(high)}, {"bound", short_numbers(bound)}};
}

/// One time per stretch: that of its first tick.
void EstimateCourse::put(Json& page) const {
  std::vector<double> t_s;
  t_s.reserve(stretches_.size());
  for (const Stretch& stretch : stretches_) {
    t_s.push_back(stretch.t_s);
  }
  page["ticks_each"] = each_;
  page["t_s"] = t_s;
  page["position_mm"] = column(&Stretch::position);
  page["velocity_mm_s"] = column(&Stretch::velocity);
  page["acceleration_mm_s2"] = column(&Stretch::acceleration);
}

/// What --json prints, and the course as bands.
Json estimate_page(const Json& answer, const EstimatePage& page, const EstimateCourse& course) {
  Json out = page_head("steadyrest-motion/1");
  out.update(
      {{"kind", "estimate"}, {"log", page.log}, {"count_mm", page.count_mm}, {"answer", answer}});
  course.put(out);
  return out;
}

}  // namespace steadyrest::apps::page
