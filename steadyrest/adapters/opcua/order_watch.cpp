// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/adapters/opcua/order_watch.hpp>

namespace steadyrest::adapters::opcua {

void OrderWatch::sent(std::uint32_t heartbeat) noexcept {
  if (fresh_ == 0) {
    from_ = heartbeat;
    ahead_ = 0;
  } else if (ahead_ < period_) {
    ahead_ += (heartbeat + period_ - newest_) % period_;
  }
  newest_ = heartbeat;
  fresh_ = kReadings;
}

void OrderWatch::seen(double heartbeat) noexcept {
  if (!std::isfinite(heartbeat) || other()) {
    return;
  }
  const bool changed = std::exchange(shown_, true) && heartbeat != last_;
  last_ = heartbeat;
  fresh_ = fresh_ > 0 ? fresh_ - 1 : 0;
  without_ = without_ < kReadings ? without_ + 1 : without_;
  if (!changed || fresh_ == 0 || heartbeat == 0.0) {
    return;
  }
  const bool whole = heartbeat >= 1.0 && heartbeat <= static_cast<double>(period_);
  const auto number = whole ? static_cast<std::uint32_t>(heartbeat) : 0;
  if (whole && (ahead_ >= period_ || way(number) <= way(newest_))) {
    from_ = number;
    ahead_ = way(newest_);
  } else {
    others_ = without_ < kReadings ? others_ + 1 : 1;
    without_ = 0;
  }
}

}  // namespace steadyrest::adapters::opcua
