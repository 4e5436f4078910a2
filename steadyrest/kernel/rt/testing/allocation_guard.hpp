// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace steadyrest::kernel::rt::testing {

/// While it lives, any `operator new` of this thread makes the running GoogleTest fail.
///
/// Link `steadyrest_allocation_guard` into the test, never into anything else: it replaces the
/// global operators. Guards may be nested; each reports the allocations made while it lived.
class AllocationGuard {
 public:
  AllocationGuard() noexcept;
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Allocations of this thread since the guard was made.
  [[nodiscard]] std::size_t allocations() const noexcept;
  /// Forgives the allocations so far: they do not fail the test.
  void forgive() noexcept;

 private:
  std::size_t at_start_;
};

}  // namespace steadyrest::kernel::rt::testing
