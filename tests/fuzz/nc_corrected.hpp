// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "nc_mutator.hpp"

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>
#include <steadyrest/nc/rewrite/text/plan_file.hpp>
#include <steadyrest/nc/rewrite/text/settings.hpp>

/// Common parts of the rewriter's targets: an input is a byte that chooses the control, a byte that
/// chooses the plan, and a program.
namespace steadyrest::fuzz {

inline constexpr std::array kMethods = {nc::rewrite::Method::linuxcnc, nc::rewrite::Method::fanuc,
                                        nc::rewrite::Method::haas,
                                        nc::rewrite::Method::r_parameter};
inline constexpr std::array<std::uint8_t, 4> kDialectOf = {0, 1, 1, 2};
inline constexpr std::size_t kHead = 2;

/// One program with everything a correction needs.
struct Job {
  Job(std::string_view program, nc::rewrite::Method method, std::uint8_t choice);

  /// A plan for about the program's time; none when no correction can be written: the interpreter
  /// refuses the program, or it would take too long to time many times a second.
  bool plan_it(std::uint8_t choice);

  std::string_view text;
  nc::interpret::Config config;
  nc::rewrite::Settings settings;
  nc::rewrite::Plan plan;
};

/// Three linear and three rotary axes; a coarse period, since each run times programs many times.
const kernel::machine::Machine& mill();

/// Two files in a folder of this process, in memory where the system has such a folder.
struct Files {
  Files();
  ~Files();
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  std::string folder;
  std::string original;
  std::string changed;
};
Files& files();
void write_file(const std::string& path, std::string_view text);
std::string read_file(const std::string& path);

}  // namespace steadyrest::fuzz
