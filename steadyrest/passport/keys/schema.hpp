// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>

/// The machine file's schema: one table for each section, one row for each key. Reader, reference
/// page and suggestions all come from these rows, so none of them can disagree.
namespace steadyrest::passport {

/// A key whose value is one of a few words.
template <class S>
struct Choice {
  std::span<const std::string_view> words;
  void (*set)(S&, std::size_t) = nullptr;
  std::size_t (*get)(const S&) = nullptr;
  bool operator==(const Choice& other) const noexcept { return set == other.set; }
};

template <class S>
using Field = std::variant<double S::*, bool S::*, std::uint32_t S::*, std::uint64_t S::*,
                           std::int64_t S::*, std::string S::*, std::vector<double> S::*,
                           std::vector<std::uint32_t> S::*, Choice<S>>;

/// Which axes a key is for: X Y Z U V W are linear, A B C rotary.
enum class For : std::uint8_t { any, linear, rotary };
enum class Need : std::uint8_t { optional, mandatory };

/// One key. Two keys with the same field are two units for one quantity: a file may give only one.
template <class S>
struct Key {
  std::string_view name;  ///< ends in its unit
  Field<S> field;
  double min = 0.0;  ///< smallest and largest value allowed, in the key's own unit
  double max = 0.0;
  std::string_view meaning;
  Need need = Need::optional;
  For axes = For::any;
  std::size_t max_entries = 4096;  ///< of a list
};

/// An override section as written in the file; `make_override` turns it into the table.
struct OverrideKeys {
  kernel::machine::Coding coding = kernel::machine::Coding::gray;
  std::vector<double> percent;  ///< ratios once read
  std::vector<std::uint32_t> codes;
  double binary_max = 0.0;
  double binary_step = 0.01;
  double scan_period_s = 0.01;
  double dead_time_s = 0.0;
  bool latched_word = true;
  bool layer_may_exceed_panel = false;
  double max_ratio = 2.0;
};

/// One [[read]] or [[write]] of a mapping file as written.
struct MappingEntry {
  std::string quantity;
  std::string node;
  std::int64_t index = 0;
  std::uint32_t step = 0;
  std::uint32_t length = 0;
  double scale = 1.0;
  double offset = 0.0;
};

[[nodiscard]] std::span<const Key<kernel::machine::Machine>> top_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Control>> control_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Program>> program_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Axis>> axis_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Encoder>> encoder_keys() noexcept;
/// Longest table of line errors.
inline constexpr std::size_t kMaxLineTable = 1U << 20U;
[[nodiscard]] std::span<const Key<kernel::machine::Friction>> friction_keys() noexcept;
[[nodiscard]] std::span<const Key<OverrideKeys>> override_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Spindle>> spindle_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Contour>> contour_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Chatter>> chatter_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Compensation>> compensation_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Thermal>> thermal_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::ThermalAxis>> thermal_axis_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::ThermalMode>> thermal_mode_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::ThermalAmbient>> thermal_ambient_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Envelope>> envelope_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Simulation>> simulation_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Lines>> lines_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::OverrideWires>> wires_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::Recorder>> recorder_keys() noexcept;
[[nodiscard]] std::span<const Key<kernel::machine::OpcUa>> opcua_keys() noexcept;
[[nodiscard]] std::span<const Key<MappingEntry>> mapping_keys() noexcept;

/// The dialect that a method belongs to; `own` if the method is by_dialect.
[[nodiscard]] kernel::machine::Dialect dialect_of(kernel::machine::CompensationMethod method,
                                                  kernel::machine::Dialect own) noexcept;

/// The words of the enumerations, in the order of their values.
[[nodiscard]] std::string_view word(kernel::machine::PortKind port) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::Mode mode) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::Dialect dialect) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::Coding coding) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::ContourStrategy strategy) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::SpeedLaw law) noexcept;
[[nodiscard]] std::string_view word(kernel::machine::CompensationMethod method) noexcept;

}  // namespace steadyrest::passport
