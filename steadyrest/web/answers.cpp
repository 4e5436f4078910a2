// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <boost/asio/post.hpp>

#include <steadyrest/web/answers.hpp>

namespace steadyrest::web {

void Answers::take(Work work, bool urgent) {
  {
    const std::scoped_lock lock(mutex_);
    waiting_[urgent ? 0 : 1].push_back(std::move(work));
  }
  boost::asio::post(pool_, [this] { make_next(); });
}

// Called as often as there is work: one of the queues has some.
void Answers::make_next() {
  Work work;
  {
    const std::scoped_lock lock(mutex_);
    auto& queue = waiting_[waiting_[0].empty() ? 1 : 0];
    work = std::move(queue.front());
    queue.pop_front();
  }
  work();
}

}  // namespace steadyrest::web
