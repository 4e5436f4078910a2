// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <utility>

#include <unistd.h>

#include <steadyrest/kernel/file/temporary.hpp>

// Two ways to remove it: the object removes its file, and a signal handler removes all that are
// registered. Neither survives SIGKILL, which is why output_file prefers files without a name.
namespace steadyrest::kernel::file {
namespace {

enum class Use : int { free, filling, file, folder };

struct Slot {
  std::atomic<Use> use = Use::free;
  std::array<char, 4096> path{};
};

// A signal handler may neither allocate nor lock. A verb has at most a handful open at a time; any
// beyond this table is removed by its object alone.
std::array<Slot, 16> slots;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
static_assert(std::atomic<Use>::is_always_lock_free);

std::optional<std::size_t> occupy(const std::string& path, Temporary::Kind kind) {
  for (std::size_t i = 0; i < slots.size() && path.size() < slots[i].path.size(); ++i) {
    Use expected = Use::free;
    if (slots[i].use.compare_exchange_strong(expected, Use::filling)) {
      std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
      slots[i].use = kind == Temporary::Kind::file ? Use::file : Use::folder;
      return i;
    }
  }
  return std::nullopt;
}

// A signal may arrive on any thread, so no thread can block it for the whole process. Each side
// first announces what it is about to do, then checks the other, so at least one gives way.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<int> held_back = 0;  ///< objects of SignalsHeldBack
std::atomic<int> ending = 0;     ///< the signal that came
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

// Async-signal-safe calls only: unlink, rmdir, signal, raise. The process ends by the same signal,
// so that the shell sees why.
extern "C" void remove_and_end(int signal) {
  ending = signal;
  if (held_back > 0) {
    return;
  }
  for (Slot& slot : slots) {
    if (slot.use == Use::file) {
      ::unlink(slot.path.data());
    }
  }
  for (Slot& slot : slots) {  // deeper folders were registered later
    Slot& last = slots[static_cast<std::size_t>(&slots.back() - &slot)];
    if (last.use == Use::folder) {
      ::rmdir(last.path.data());
    }
  }
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace

Temporary::Temporary(std::string path, Kind kind)
    : path_(std::move(path)), kind_(kind), slot_(occupy(path_, kind)) {}

Temporary::Temporary(Temporary&& other) noexcept
    : path_(std::exchange(other.path_, {})),
      kind_(other.kind_),
      slot_(std::exchange(other.slot_, std::nullopt)) {}

Temporary& Temporary::operator=(Temporary&& other) noexcept {
  if (this != &other) {
    remove();
    path_ = std::exchange(other.path_, {});
    kind_ = other.kind_;
    slot_ = std::exchange(other.slot_, std::nullopt);
  }
  return *this;
}

Temporary::~Temporary() {
  remove();
}

void Temporary::remove() noexcept {
  if (!path_.empty()) {
    kind_ == Kind::file ? ::unlink(path_.c_str()) : ::rmdir(path_.c_str());
  }
  keep();
}

// Slot first, then path: the handler must not see a name that is no longer ours.
void Temporary::keep() noexcept {
  if (slot_) {
    slots[*slot_].use = Use::free;
  }
  slot_.reset();
  path_.clear();
}

void remove_temporaries_on_signals() {
  // nohup and background jobs ignore some signals on purpose; those stay ignored.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
    struct sigaction before{};
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
      struct sigaction now{};
      now.sa_handler = remove_and_end;
      sigfillset(&now.sa_mask);
      // Unblocked, so that raise() in the handler ends the process at once.
      sigdelset(&now.sa_mask, signal);
      now.sa_flags = SA_NODEFER;
      ::sigaction(signal, &now, nullptr);
    }
  }
  // A closed pipe or a full quota then becomes an error of write(), with a refusal that names the
  // file.
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
}

SignalsHeldBack::SignalsHeldBack() noexcept {
  ++held_back;
  if (ending != 0) {
    --held_back;
    remove_and_end(ending);
  }
}

SignalsHeldBack::~SignalsHeldBack() {
  if (--held_back == 0 && ending != 0) {
    remove_and_end(ending);
  }
}

}  // namespace steadyrest::kernel::file
