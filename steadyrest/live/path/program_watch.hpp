// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <steadyrest/kernel/machine/machine.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/nc/interpret/state/config.hpp>

namespace steadyrest::live {

/// What a control has loaded.
struct LoadedProgram {
  std::string file;             ///< empty: none
  nc::interpret::Config start;  ///< what the interpreter must know; taken while no program runs
  bool stopped = true;          ///< no program runs
  bool text_is_file = true;     ///< the control has the text that the file holds now

  friend bool operator==(const LoadedProgram&, const LoadedProgram&) = default;
};

/// Keeps a FollowedPort's path that of the loaded program, in its own thread: reads and plans
/// it when another one is loaded, when its text changes and when the control's offsets do. A
/// program whose text changes while it runs, or that began unseen, has no path until it has ended;
/// only the state that the watch begins with may be that of a program that runs.
class ProgramWatch {
 public:
  /// The newest state of the control; nothing when none came within the time. Called in the
  /// watch's thread alone.
  using Source =
      std::function<kernel::outcome::Result<std::optional<LoadedProgram>>(double wait_s)>;
  struct Status {
    std::string file;          ///< empty: none loaded
    std::size_t segments = 0;  ///< of the path; 0: there is none
    /// Why there is none; else what the layer leaves to the program's text; empty: nothing.
    std::string words;
  };

  /// Why a program cannot be planned, and what the layer leaves to its text; called in the watch's
  /// thread.
  using Warn = std::function<void(const std::string& words)>;

  ProgramWatch(FollowedPort& port, kernel::machine::Machine machine, Source source, Warn warn);
  ProgramWatch(const ProgramWatch&) = delete;
  ProgramWatch& operator=(const ProgramWatch&) = delete;
  ~ProgramWatch();

  [[nodiscard]] Status status() const;

 private:
  /// Tells two texts of a file, and of the subprograms that it calls, apart.
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  using Stamps = std::vector<Stamp>;
  [[nodiscard]] Stamps stamps_of(const std::string& file) const;

  void watch();
  void look(const LoadedProgram& loaded);
  [[nodiscard]] bool holds_while_it_runs(const LoadedProgram& loaded, bool same_text,
                                         bool same_start);
  void plan(const LoadedProgram& loaded);
  void withdraw(const std::string& file, std::string words);
  void say(Status status);

  FollowedPort& port_;
  kernel::machine::Machine machine_;
  Source source_;
  Warn warn_;
  // Of the thread.
  LoadedProgram planned_;
  std::optional<Stamps> stamp_;           ///< of the texts that were planned, or refused
  std::vector<std::string> subprograms_;  ///< of the program that was planned
  std::string marked_;                    ///< the file whose marks the port was told
  double plan_s_ = 0.0;                   ///< that took so long
  bool relative_ = false;                 ///< its end follows from where it starts
  std::string withdrawn_;                 ///< why it has no path while it runs; empty: it has one
  bool seen_ = false;                     ///< there was a state
  bool lost_ = false;                     ///< the last one did not come
  mutable std::mutex mutex_;
  Status status_;
  std::atomic<bool> ends_{false};
  std::thread thread_;  ///< last: it uses the others
};

}  // namespace steadyrest::live
