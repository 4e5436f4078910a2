// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include <steadyrest/adapters/linuxcnc/config/machine_differences.hpp>
#include <steadyrest/apps/cli/ports/linuxcnc_control.hpp>
#include <steadyrest/apps/cli/ports/linuxcnc_live.hpp>

namespace steadyrest::apps::cli::live {
namespace {

namespace adapter = adapters::linuxcnc;
namespace config = adapter::config;
using steadyrest::live::LoadedProgram;

constexpr double kFirstState_s = 5.0;
constexpr double kPoll_s = 0.1;
constexpr std::chrono::seconds kBetweenStarts(2);
constexpr std::string_view kVersion = "2.9";

Refusals differences(const ControlFile& control, const kernel::machine::Machine& machine) {
  Refusals out;
  for (auto& found : config::differences(control.ini, control.configuration, machine)) {
    out.push_back(bad_input(std::move(found.what), std::move(found.to_do)));
  }
  return out;
}

}  // namespace

Result<void> ControlSource::start() {
  if (!peer_) {
    auto started = adapter::ControlPeer::start({});
    if (!started) {
      return std::unexpected(std::move(started.error()));
    }
    peer_ = std::move(*started);
  }
  return {};
}

Result<adapter::ControlState> ControlSource::first(double timeout_s) {
  if (auto started = start(); !started) {
    return std::unexpected(std::move(started.error()));
  }
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  Result<std::optional<adapter::ControlState>> state = std::optional<adapter::ControlState>();
  while (state && !*state && std::chrono::steady_clock::now() < until) {
    state = peer_->next(kPoll_s);
  }
  if (!state) {
    return ended(std::move(state.error()));
  }
  if (!*state) {
    return kernel::outcome::unavailable("LinuxCNC does not show its status",
                                        "see whether it runs, as this user");
  }
  return std::move(**state);
}

std::unexpected<Refusal> ControlSource::ended(Refusal why) {
  peer_.reset();
  begins_again_ = std::chrono::steady_clock::now() + kBetweenStarts;
  ended_ = why;
  return std::unexpected(std::move(why));
}

Result<std::optional<LoadedProgram>> ControlSource::operator()(double wait_s) {
  const auto failed = [wait_s](Refusal refusal) {
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    return std::unexpected(std::move(refusal));
  };
  if (!peer_ && ended_ && std::chrono::steady_clock::now() < begins_again_) {
    return failed(*ended_);
  }
  if (auto started = start(); !started) {
    return failed(ended(std::move(started.error())).error());
  }
  auto state = peer_->next(wait_s);
  if (!state) {
    return failed(ended(std::move(state.error())).error());
  }
  if (!*state) {
    return std::optional<LoadedProgram>();
  }
  if (!(*state)->stopped && at_rest_ && at_rest_->file == (*state)->program) {
    LoadedProgram runs = *at_rest_;
    runs.stopped = false;
    runs.text_is_file = (*state)->text_is_file;
    return std::optional(std::move(runs));
  }
  auto loaded = loaded_program(**state, machine_);
  if (!loaded) {
    return std::unexpected(std::move(loaded.error()));
  }
  if (loaded->stopped) {
    at_rest_ = *loaded;
  }
  return std::optional(std::move(*loaded));
}

std::expected<Compared, Refusals> compare_with_control(ControlSource& source,
                                                       const kernel::machine::Machine& machine) {
  constexpr std::string_view kCheck = "control";
  Compared out;
  const auto not_compared = [&](const Refusal& refusal) {
    out.findings.push_back({passport::Severity::warning, kCheck,
                            "the machine file was not compared with LinuxCNC: " + refusal.what,
                            refusal.to_do});
    return out;
  };
  const auto state = source.first(kFirstState_s);
  if (!state) {
    out.shown = false;
    return not_compared(state.error());
  }
  if (!state->version.starts_with(kVersion)) {
    return refused(bad_input(
        fmt::format("LinuxCNC {} runs here; the layer is made for {}", state->version, kVersion),
        "install LinuxCNC 2.9 (Debian: linuxcnc-uspace)"));
  }
  auto ini = config::IniFile::read(state->ini);
  if (!ini) {
    return not_compared(ini.error());
  }
  auto configuration = config::configuration_of(*ini);
  if (!configuration) {
    return refused(configuration.error());
  }
  out.file.emplace(ControlFile{.ini = std::move(*ini), .configuration = std::move(*configuration)});
  if (Refusals different = differences(*out.file, machine); !different.empty()) {
    return std::unexpected(std::move(different));
  }
  return out;
}

Result<void> accepts(const kernel::machine::Machine& running,
                     const std::optional<ControlFile>& control,
                     const kernel::machine::Machine& wanted) {
  if (control) {
    if (Refusals different = differences(*control, wanted); !different.empty()) {
      return std::unexpected(std::move(different.front()));
    }
  }
  if (auto changed = config::changed_since_start(running, wanted)) {
    return refuse(wanted.file, std::move(changed->what), std::move(changed->to_do));
  }
  return {};
}

}  // namespace steadyrest::apps::cli::live
