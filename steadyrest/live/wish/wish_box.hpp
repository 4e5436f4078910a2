// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <semaphore>

#include <steadyrest/supervisor/wish.hpp>

namespace steadyrest::live {

/// One wish on its way to the cycle, and its outcome on the way back.
///
/// Those who ask wait for one another and for the cycle, for a bounded time; the cycle waits for
/// nobody. A wish that was given up is never taken later.
class WishBox {
 public:
  /// From any thread but the cycle's. None: nobody took it within `patience_s`, and nobody will.
  [[nodiscard]] std::optional<supervisor::WishOutcome> ask(const supervisor::Wish& wish,
                                                           double patience_s);
  /// In the cycle: the wish that waits, null if there is none. It lives until answer().
  [[nodiscard]] const supervisor::Wish* take() noexcept;
  /// In the cycle, after take().
  void answer(supervisor::WishOutcome outcome) noexcept;

 private:
  [[nodiscard]] std::optional<supervisor::WishOutcome> ask_alone(
      const supervisor::Wish& wish, std::chrono::duration<double> patience);

  enum class Stage : std::uint8_t { empty, asked, taken, answered };

  std::binary_semaphore asking_{1};
  std::atomic<Stage> stage_{Stage::empty};
  supervisor::Wish wish_;  ///< the asker's until `asked`, the cycle's until `answered`
  supervisor::WishOutcome outcome_ = supervisor::WishOutcome::taken;
};

}  // namespace steadyrest::live
