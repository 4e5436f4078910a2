// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/passport/file/machine_file.hpp>
#include <steadyrest/passport/keys/schema.hpp>
#include <steadyrest/record/columns.hpp>
#include <steadyrest/record/replay_port.hpp>
#include <steadyrest/supervisor/succession.hpp>
#include <steadyrest/supervisor/supervisor.hpp>
#include <steadyrest/supervisor/wish_text.hpp>
#include <steadyrest/trial/listener/listener.hpp>
#include <steadyrest/trial/replay/replay.hpp>

namespace steadyrest::trial::replay {
namespace {

using kernel::machine::Mode;
using kernel::outcome::refuse;
using kernel::outcome::Result;
using kernel::signal::Command;
using record::ReplayPort;

constexpr std::uint64_t kCyclesBetweenProgress = 4096;

std::vector<std::string> differing_fields(Command one, Command other) {
  std::vector<std::uint64_t> bits;
  auto keep = [&bits](const record::ColumnName&, auto& value) {
    bits.push_back(record::to_bits(value));
  };
  record::command_columns(one, keep);
  std::vector<std::string> fields;
  std::size_t at = 0;
  auto compare = [&](const record::ColumnName& name, auto& value) {
    if (record::to_bits(value) != bits[at++]) {
      fields.push_back(name.text());
    }
  };
  record::command_columns(other, compare);
  return fields;
}

std::optional<Mode> mode_of(const std::string& text) {
  for (const Mode mode : {Mode::observe, Mode::advise, Mode::act}) {
    if (passport::word(mode) == text) {
      return mode;
    }
  }
  return std::nullopt;
}

/// The layer of the run, and the file that it was made from.
struct Deciding {
  kernel::machine::Machine machine;
  supervisor::Supervisor layer;
  std::unique_ptr<const listener::Listener> listener;  ///< null: it heard nothing
};

/// The layer that the run began with.
Result<Deciding> begin(const std::string& file, kernel::machine::Machine machine,
                       const ReplayPort& port) {
  std::unique_ptr<const listener::Listener> listener;
  if (const std::string& text = port.reader().run().listener; !text.empty()) {
    auto read = listener::parse(text, file);
    if (!read) {
      return std::unexpected(std::move(read.error()));
    }
    listener = std::make_unique<const listener::Listener>(std::move(*read));
  }
  machine = listener::machine_for(listener.get(), std::move(machine));
  auto layer = listener::layer_of(listener.get(), machine, port.capability());
  if (!layer) {
    return std::unexpected(std::move(layer.error()));
  }
  return Deciding{std::move(machine), std::move(*layer), std::move(listener)};
}

/// As in the run: the new layer takes over between two cycles.
Result<void> reload(const std::string& file, const std::string& text,
                    const kernel::port::Capability& capability, Deciding& deciding) {
  auto machine = passport::parse(text, file + " (machine file of a reload)");
  if (!machine) {
    return std::unexpected(std::move(machine.error()));
  }
  *machine = listener::machine_for(deciding.listener.get(), std::move(*machine));
  if (auto fit = supervisor::fits(deciding.machine, *machine); !fit) {
    return fit;
  }
  auto next = listener::layer_of(deciding.listener.get(), *machine, capability);
  if (!next) {
    return std::unexpected(std::move(next.error()));
  }
  next->take_over(deciding.layer, supervisor::kept(deciding.machine, *machine));
  deciding.machine = std::move(*machine);
  deciding.layer = std::move(*next);
  return {};
}

/// What was changed before this cycle; refuses a mode or a wish that cannot be read and a file that
/// does not fit.
Result<void> change(const std::string& file, ReplayPort& port, Reloads reloads, Deciding& deciding,
                    Replayed& replayed) {
  while (const record::Event* const event = port.change_due()) {
    if (event->kind == record::EventKind::reload) {
      ++replayed.reloads;
      if (reloads == Reloads::follow) {
        if (auto done = reload(file, event->text, port.capability(), deciding); !done) {
          return done;
        }
      }
      continue;
    }
    if (event->kind == record::EventKind::wish) {
      const auto recorded = supervisor::wish_of(event->text);
      if (!recorded) {
        return refuse(file, "has a wish that cannot be read: " + event->text,
                      "use the version of Steadyrest that recorded it");
      }
      ++replayed.wishes;
      (void)supervisor::grant(deciding.layer, recorded->wish);
      continue;
    }
    const auto mode = mode_of(event->text);
    if (!mode) {
      return refuse(file, "sets an unknown mode: " + event->text,
                    "use the version of Steadyrest that recorded it");
    }
    deciding.layer.set_mode(*mode);
  }
  return {};
}

void compare(const record::Sample& sample, const Command& decided, Replayed& replayed) {
  ++replayed.cycles;
  auto fields = differing_fields(sample.command, decided);
  if (fields.empty()) {
    return;
  }
  ++replayed.different;
  if (!replayed.first_difference) {
    replayed.first_difference = Difference{.cycle = sample.frame.cycle,
                                           .time_s = sample.frame.time_s,
                                           .line = sample.frame.program_line,
                                           .fields = std::move(fields),
                                           .recorded = sample.command,
                                           .decided = decided};
  }
}

/// A port that keeps what it was told to write: a cycle whose command is not taken gives none.
class Watched final : public kernel::port::Port {
 public:
  explicit Watched(ReplayPort& port) : port_(port) {}
  [[nodiscard]] kernel::port::Capability capability() const noexcept override {
    return port_.capability();
  }
  Result<kernel::signal::Frame> read() noexcept override {
    refused_.reset();
    return port_.read();
  }
  Result<void> write(const Command& command) noexcept override {
    auto written = port_.write(command);
    if (!written) {
      refused_ = command;
    }
    return written;
  }
  [[nodiscard]] const std::optional<Command>& refused() const noexcept { return refused_; }

 private:
  ReplayPort& port_;
  std::optional<Command> refused_;
};

}  // namespace

Result<Replayed> replay(const std::string& file, const kernel::machine::Machine& machine,
                        const std::function<bool(double share)>& goes_on, Reloads reloads) {
  auto opened = ReplayPort::open(file);
  if (!opened) {
    return std::unexpected(std::move(opened.error()));
  }
  ReplayPort& port = **opened;
  auto begun = begin(file, machine, port);
  if (!begun) {
    return std::unexpected(std::move(begun.error()));
  }
  Deciding& deciding = *begun;
  Watched watched(port);
  Replayed replayed;
  replayed.paths_complete = port.reader().paths_complete();
  const auto samples =
      static_cast<double>(std::max<std::uint64_t>(1, port.reader().totals().samples));
  std::uint64_t expected = 0;
  while (true) {
    if (auto changed = change(file, port, reloads, deciding, replayed); !changed) {
      return std::unexpected(std::move(changed.error()));
    }
    if (port.finished()) {
      break;
    }
    if (const auto next = port.next_number(); next && *next != expected) {
      replayed.gap_after = port.sample().frame.cycle;
      break;
    }
    const auto decided = deciding.layer.cycle(watched, {});
    if (!decided && !watched.refused()) {
      continue;  // a cycle without a frame, as it was
    }
    ++expected;
    compare(port.sample(), decided ? *decided : *watched.refused(), replayed);
    if (replayed.cycles % kCyclesBetweenProgress == 0 &&
        !goes_on(static_cast<double>(replayed.cycles) / samples)) {
      return kernel::outcome::refuse("the replay was given up", "begin it again");
    }
  }
  if (port.fault()) {
    return std::unexpected(*port.fault());
  }
  return replayed;
}

}  // namespace steadyrest::trial::replay
