// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/web/secret.hpp>
#include <steadyrest/web/sessions.hpp>

namespace steadyrest::web {

bool Sessions::is_over(const Entry& entry, double now_s) const noexcept {
  return now_s - entry.begun_s > config_.longest_s || now_s - entry.used_s > config_.idle_s;
}

/// Of its own first, so that nobody's log-ins end the sessions of others.
void Sessions::make_room(const Caller& caller, double now_s) {
  std::erase_if(by_digest_, [&](const auto& at) { return is_over(at.second, now_s); });
  const auto is_own = [&](const auto& at) { return at.second.session.caller.name == caller.name; };
  const bool has_many =
      std::cmp_greater_equal(std::ranges::count_if(by_digest_, is_own), config_.most_of_caller);
  if (has_many || by_digest_.size() >= config_.most) {
    by_digest_.erase(std::ranges::min_element(by_digest_, {}, [&](const auto& at) {
      return std::pair(has_many && !is_own(at), at.second.used_s);
    }));
  }
}

Sessions::Begun Sessions::begin(const Caller& caller, double now_s, std::string mark) {
  Begun out{.id = new_secret(),
            .session = {.caller = caller, .csrf = new_secret(), .mark = std::move(mark)}};
  const std::scoped_lock lock(mutex_);
  make_room(caller, now_s);
  by_digest_[digest(out.id)] = {.session = out.session, .begun_s = now_s, .used_s = now_s};
  return out;
}

std::optional<Sessions::Session> Sessions::find(std::string_view id, double now_s) {
  const std::scoped_lock lock(mutex_);
  const auto at = by_digest_.find(digest(id));
  if (at == by_digest_.end() || is_over(at->second, now_s)) {
    return std::nullopt;
  }
  at->second.used_s = now_s;
  return at->second.session;
}

std::optional<Sessions::Session> Sessions::look_at(std::string_view id, double now_s) const {
  const std::scoped_lock lock(mutex_);
  const auto at = by_digest_.find(digest(id));
  return at != by_digest_.end() && now_s - at->second.begun_s <= config_.longest_s
             ? std::optional(at->second.session)
             : std::nullopt;
}

void Sessions::end(std::string_view id) {
  const std::scoped_lock lock(mutex_);
  by_digest_.erase(digest(id));
}

}  // namespace steadyrest::web
