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

bool SlowAnswers::take(Work work) {
  if (taken_.fetch_add(1) >= most_) {
    taken_.fetch_sub(1);
    return false;
  }
  boost::asio::post(pool_, [this, work = std::move(work)] {
    lower_priority();
    const auto deliver = work(stop_.get_token());
    taken_.fetch_sub(1);
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
