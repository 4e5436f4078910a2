// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace steadyrest::kernel::file {

/// Watches whether a file still has a name. One that was removed can be written for as long as it
/// is open, and is lost then; one that was moved is not.
///
/// The file is not opened: closing it would drop SQLite's locks.
class Presence {
 public:
  explicit Presence(const std::string& file);
  Presence(Presence&& other) noexcept;
  Presence& operator=(Presence&&) = delete;
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;
  ~Presence();

  /// It was there and has no name any more.
  [[nodiscard]] bool is_removed() const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace steadyrest::kernel::file
