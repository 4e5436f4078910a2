// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>

#include <steadyrest/kernel/rt/testing/allocation_guard.hpp>

// Counts calls, per thread, of the replaced global operators. Memory that a library allocates with
// malloc itself goes unseen; the project's code in the cycle calls no such library.
namespace steadyrest::kernel::rt::testing {
namespace {

// Per thread: a logger that allocates in parallel is no fault of the cycle.
thread_local std::size_t allocation_count = 0;

void* allocate(std::size_t size) {
  ++allocation_count;
  // NOLINTNEXTLINE(cppcoreguidelines-no-malloc): this is what operator new is made of.
  return std::malloc(size == 0 ? 1 : size);
}

// aligned_alloc wants a size that is a multiple of the alignment.
void* allocate_aligned(std::size_t size, std::align_val_t alignment) {
  ++allocation_count;
  const auto align = static_cast<std::size_t>(alignment);
  return std::aligned_alloc(align, (size + align - 1) / align * align);
}

// The plain forms of operator new must throw, the nothrow forms must not.
void* or_throw(void* memory) {
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}

}  // namespace

AllocationGuard::AllocationGuard() noexcept : at_start_(allocation_count) {}

// In the destructor, so that no test can forget to check.
AllocationGuard::~AllocationGuard() {
  if (const std::size_t count = allocations(); count != 0) {
    ADD_FAILURE() << count << " allocations where none is allowed";
  }
}

std::size_t AllocationGuard::allocations() const noexcept {
  return allocation_count - at_start_;
}

// For a first call that is allowed to allocate.
void AllocationGuard::forgive() noexcept {
  at_start_ = allocation_count;
}

}  // namespace steadyrest::kernel::rt::testing

namespace guard = steadyrest::kernel::rt::testing;

// The global operators; the library's array and sized forms end up in these.
void* operator new(std::size_t size) {
  return guard::or_throw(guard::allocate(size));
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return guard::allocate(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return guard::or_throw(guard::allocate_aligned(size, alignment));
}
void* operator new(std::size_t size, std::align_val_t alignment,
                   const std::nothrow_t& /*tag*/) noexcept {
  return guard::allocate_aligned(size, alignment);
}
void* operator new[](std::size_t size) {
  return guard::or_throw(guard::allocate(size));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return guard::or_throw(guard::allocate_aligned(size, alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
void operator delete[](void* memory, std::size_t /*size*/,
                       std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
