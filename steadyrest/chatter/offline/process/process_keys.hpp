// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <steadyrest/chatter/offline/process/process.hpp>
#include <steadyrest/passport/keys/schema.hpp>

/// The process file's schema: one table for each section, one row for each key.
namespace steadyrest::chatter::offline {

/// A [[mode]] as written in the file.
struct ModeKeys {
  enum class Axis : std::uint8_t { x, y };
  Axis axis = Axis::x;
  double angle_rad = 0.0;
  double frequency_hz = 0.0;
  double damping_ratio = 0.0;
  double mass_kg = 0.0;
  double stiffness_n_mm = 0.0;
};

/// A [[frf]]: a measured response, fitted to modes.
struct FrfKeys {
  std::string file;
  ModeKeys::Axis axis = ModeKeys::Axis::x;
};

[[nodiscard]] std::span<const passport::Key<Process>> process_keys() noexcept;
[[nodiscard]] std::span<const passport::Key<Tool>> tool_keys() noexcept;
[[nodiscard]] std::span<const passport::Key<Cut>> cut_keys() noexcept;
[[nodiscard]] std::span<const passport::Key<ModeKeys>> mode_keys() noexcept;
[[nodiscard]] std::span<const passport::Key<FrfKeys>> frf_keys() noexcept;

}  // namespace steadyrest::chatter::offline
