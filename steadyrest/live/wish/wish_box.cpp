// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <thread>

#include <steadyrest/live/wish/wish_box.hpp>

namespace steadyrest::live {

using supervisor::Wish;
using supervisor::WishOutcome;

namespace {

constexpr auto kLookForAnswer = std::chrono::milliseconds(1);

}  // namespace

// The loop makes no system call to wake those who ask, so they look. What it has taken it answers
// before its next cycle.
std::optional<WishOutcome> WishBox::ask(const Wish& wish, double patience_s) {
  const std::chrono::duration<double> patience(patience_s);
  if (!asking_.try_acquire_for(patience)) {
    return std::nullopt;
  }
  auto outcome = ask_alone(wish, patience);
  asking_.release();
  return outcome;
}

std::optional<WishOutcome> WishBox::ask_alone(const Wish& wish,
                                              std::chrono::duration<double> patience) {
  wish_ = wish;
  stage_.store(Stage::asked);
  const auto until = std::chrono::steady_clock::now() + patience;
  while (stage_.load() != Stage::answered) {
    Stage waiting = Stage::asked;
    if (std::chrono::steady_clock::now() >= until &&
        stage_.compare_exchange_strong(waiting, Stage::empty)) {
      return std::nullopt;
    }
    std::this_thread::sleep_for(kLookForAnswer);
  }
  const WishOutcome outcome = outcome_;
  stage_.store(Stage::empty);
  return outcome;
}

const Wish* WishBox::take() noexcept {
  Stage waiting = Stage::asked;
  return stage_.compare_exchange_strong(waiting, Stage::taken) ? &wish_ : nullptr;
}

void WishBox::answer(WishOutcome outcome) noexcept {
  outcome_ = outcome;
  stage_.store(Stage::answered);
}

}  // namespace steadyrest::live
