// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include <steadyrest/web/role.hpp>

namespace steadyrest::web {

/// Who is logged in. Time comes in with each call. From any thread.
class Sessions {
 public:
  struct Config {
    double longest_s = 12.0 * 3600.0;
    double idle_s = 30.0 * 60.0;
    std::size_t most = 256;           ///< the one that was idle longest gives way
    std::size_t most_of_caller = 16;  ///< the same among those of one name
  };
  struct Session {
    Caller caller;
    std::string csrf;  ///< what a write must bring along: another site cannot know it
    std::string mark;  ///< of the account as it was at the log-in
  };
  /// A session and the secret that its holder shows.
  struct Begun {
    std::string id;
    Session session;
  };

  explicit Sessions(const Config& config) : config_(config) {}
  Sessions() : Sessions(Config{}) {}

  [[nodiscard]] Begun begin(const Caller& caller, double now_s, std::string mark = {});
  /// Nothing for one that has ended; counts as use.
  [[nodiscard]] std::optional<Session> find(std::string_view id, double now_s);
  /// The same without counting as use: a page that only watches does not stay logged in for ever.
  [[nodiscard]] std::optional<Session> look_at(std::string_view id, double now_s) const;
  void end(std::string_view id);

 private:
  struct Entry {
    Session session;
    double begun_s = 0.0;
    double used_s = 0.0;
  };
  [[nodiscard]] bool is_over(const Entry& entry, double now_s) const noexcept;
  void make_room(const Caller& caller, double now_s);

  Config config_;
  mutable std::mutex mutex_;
  std::unordered_map<std::string, Entry> by_digest_;
};

}  // namespace steadyrest::web
