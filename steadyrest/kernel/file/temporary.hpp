// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace steadyrest::kernel::file {

/// A file or an empty folder that is removed unless it is kept: with this object, and also when a
/// signal ends the process (remove_temporaries_on_signals).
///
/// The name is registered before anything of that name is made, so there is no gap in the cover.
/// Only SIGKILL and a power cut can leave it behind.
class Temporary {
 public:
  enum class Kind { file, folder };

  Temporary() = default;
  Temporary(std::string path, Kind kind);
  Temporary(Temporary&& other) noexcept;
  Temporary& operator=(Temporary&& other) noexcept;
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// It is no longer temporary, or has been renamed.
  void keep() noexcept;

 private:
  void remove() noexcept;

  std::string path_;  ///< empty when there is nothing to remove
  Kind kind_ = Kind::file;
  std::optional<std::size_t> slot_;  ///< in the table of the signal handler
};

/// Called at a program's start: SIGINT, SIGTERM, SIGHUP and SIGQUIT remove all temporaries and then
/// end the process as usual (a signal that is ignored stays ignored). A closed pipe and a file
/// above the permitted size become errors of write() instead of signals.
void remove_temporaries_on_signals();

/// Holds those signals back while it lives: the process ends when the object goes, not before.
class SignalsHeldBack {
 public:
  SignalsHeldBack() noexcept;
  ~SignalsHeldBack();
  SignalsHeldBack(const SignalsHeldBack&) = delete;
  SignalsHeldBack& operator=(const SignalsHeldBack&) = delete;
};

}  // namespace steadyrest::kernel::file
