// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <steadyrest/web/rate_limit.hpp>

namespace steadyrest::web {

double RateLimit::left(const Bucket& bucket, double now_s) const {
  const double more = std::max(0.0, now_s - bucket.at_s) * config_.per_s;
  return std::min(config_.burst, bucket.left + more);
}

double RateLimit::left(const std::string& key, double now_s) const {
  const auto at = by_key_.find(key);
  return at == by_key_.end() ? config_.burst : left(at->second, now_s);
}

/// Forgets those that have more than half left, where there is no room for a new key; else the
/// fullest. All that have so much, since a flood of keys would else search all of them each time.
void RateLimit::make_room(const std::string& key, double now_s) {
  if (by_key_.size() < config_.most_keys || by_key_.contains(key)) {
    return;
  }
  std::erase_if(by_key_,
                [&](const auto& at) { return left(at.second, now_s) > 0.5 * config_.burst; });
  if (by_key_.size() >= config_.most_keys) {
    by_key_.erase(std::ranges::max_element(by_key_, {},
                                           [&](const auto& at) { return left(at.second, now_s); }));
  }
}

bool RateLimit::take(const std::string& key, double now_s) {
  const std::scoped_lock lock(mutex_);
  make_room(key, now_s);
  const double had = left(key, now_s);
  if (had < 1.0) {
    return false;
  }
  by_key_[key] = {.left = had - 1.0, .at_s = now_s};
  return true;
}

bool RateLimit::has_room(const std::string& key, double now_s) const {
  const std::scoped_lock lock(mutex_);
  return left(key, now_s) >= 1.0;
}

double RateLimit::wait_s(const std::string& key, double now_s) const {
  const std::scoped_lock lock(mutex_);
  return std::max(0.0, 1.0 - left(key, now_s)) / config_.per_s;
}

}  // namespace steadyrest::web
