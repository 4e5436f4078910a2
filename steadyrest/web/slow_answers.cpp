// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <boost/asio/post.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include <steadyrest/web/slow_answers.hpp>

namespace steadyrest::web {
namespace {

constexpr int kNice = 10;

/// Of this thread alone, as Linux has it.
void lower_priority() {
  static thread_local const int kLowered =
      ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
  static_cast<void>(kLowered);
}

}  // namespace

bool SlowAnswers::has_room(const std::string& client) {
  const std::scoped_lock lock(mutex_);
  const auto at = taken_.find(client);
  if (all_ >= config_.most || (at != taken_.end() && at->second >= config_.most_of_client)) {
    return false;
  }
  ++all_;
  ++taken_[client];
  return true;
}

void SlowAnswers::free(const std::string& client) {
  const std::scoped_lock lock(mutex_);
  --all_;
  if (--taken_[client] == 0) {
    taken_.erase(client);
  }
}

bool SlowAnswers::take(const std::string& client, Work work) {
  if (!has_room(client)) {
    return false;
  }
  boost::asio::post(pool_, [this, client, work = std::move(work)] {
    lower_priority();
    const auto deliver = work(stop_.get_token());
    free(client);
    deliver();
  });
  return true;
}

void SlowAnswers::end() {
  pool_.stop();  // first: none that waits is begun any more
  stop_.request_stop();
  pool_.join();
}

}  // namespace steadyrest::web
