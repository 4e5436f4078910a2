// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include <steadyrest/adapters/opcua/order_watch.hpp>

namespace steadyrest::adapters::opcua {

void OrderWatch::sent(std::uint32_t heartbeat) noexcept {
  newest_ = heartbeat;
  from_ = from_ == 0 ? heartbeat : from_;
  fresh_ = kFresh;
}

void OrderWatch::seen(double heartbeat) noexcept {
  if (!std::isfinite(heartbeat)) {
    return;
  }
  const bool changed = std::exchange(shown_, true) && heartbeat != last_;
  last_ = heartbeat;
  fresh_ = fresh_ > 0 ? fresh_ - 1 : 0;
  if (!changed || fresh_ == 0 || heartbeat == 0.0) {
    return;
  }
  // Ways round the ring of heartbeats, from the oldest that may be seen.
  const auto way = [this](std::uint32_t to) { return (to + period_ - from_) % period_; };
  const bool whole = heartbeat >= 1.0 && heartbeat <= static_cast<double>(period_);
  const auto number = whole ? static_cast<std::uint32_t>(heartbeat) : 0;
  if (whole && way(number) <= way(newest_)) {
    from_ = number;
  } else {
    ++others_;
  }
}

}  // namespace steadyrest::adapters::opcua
