// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

namespace steadyrest::web {

/// So many events at once and so many a second, for each key: a token bucket. Memory is bounded:
/// beyond `most_keys` those with more than half left are forgotten for a new one, so that many
/// addresses shut nobody out and none that has used up its share gets it back. From any thread.
class RateLimit {
 public:
  struct Config {
    double per_s = 50.0;
    double burst = 100.0;
    std::size_t most_keys = 4096;
  };

  explicit RateLimit(const Config& config) : config_(config) {}

  /// Counts one event; false: too many.
  [[nodiscard]] bool take(const std::string& key, double now_s);
  /// Whether take() would be true, without counting.
  [[nodiscard]] bool has_room(const std::string& key, double now_s) const;
  /// How long until there is room for one.
  [[nodiscard]] double wait_s(const std::string& key, double now_s) const;

 private:
  struct Bucket {
    double left = 0.0;
    double at_s = 0.0;
  };
  [[nodiscard]] double left(const Bucket& bucket, double now_s) const;
  [[nodiscard]] double left(const std::string& key, double now_s) const;
  void make_room(const std::string& key, double now_s);

  Config config_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Bucket> by_key_;
};

}  // namespace steadyrest::web
