// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <steadyrest/kernel/link/event.hpp>
#include <steadyrest/kernel/outcome/bad_input.hpp>
#include <steadyrest/kernel/outcome/result.hpp>
#include <steadyrest/kernel/rt/snapshot.hpp>

/// Slow devices (a network, a serial line, another process) behind a port.
namespace steadyrest::kernel::link {

/// Something slow that is read and written, in one thread.
template <class Sample, class Order>
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// May take long and may allocate. Refused: why there is no sample, usually `unavailable`; the
  /// next call tries again from the beginning.
  virtual outcome::Result<void> read(Sample& sample) = 0;
  /// Refused: why the order is not on the device.
  virtual outcome::Result<void> write(const Order& order) = 0;
};

/// A device in a thread of its own, so that the control cycle waits a bounded time for it.
///
/// Law. read() asks for a sample and waits for it, `patience_s` at most; one that comes later is
/// taken by the next read(), with its age. write() leaves the order and returns: the device gets it
/// before the next sample is read, and only the newest of several. So a machine that is stepped
/// between write() and read() sees every order, however slow the computer is.
/// read() and write() belong to one thread. Neither allocates nor locks, except to tell a fault.
template <class Sample, class Order>
class Exchange {
 public:
  struct Taken {
    Sample sample;
    double age_s = 0.0;  ///< since it was asked for, less the patience of one read(); ≥ 0
  };

  /// `name`: of the device, in the refusals. The device belongs to the thread from now on.
  Exchange(std::string name, std::unique_ptr<Device<Sample, Order>> device, double patience_s)
      : name_(std::move(name)),
        device_(std::move(device)),
        patience_s_(patience_s),
        thread_([this] { run(); }) {}
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;
  /// Waits for what the device is doing.
  ~Exchange() {
    ends_.store(true);
    wake_.post();
    thread_.join();
  }

  outcome::Result<Taken> read() noexcept {
    if (!waiting_) {
      waiting_ = true;
      asked_s_ = monotonic_s();
      asked_.store(true);
      wake_.post();
    }
    if (!answered_.wait(patience_s_)) {
      return outcome::unavailable(
          fmt::format("{} did not answer within {:g} s", name_, patience_s_),
          "see whether it runs and its link is sound");
    }
    waiting_ = false;
    if (faulty_.load()) {
      const std::scoped_lock lock(telling_);
      return std::unexpected(fault_);
    }
    const double late_s = monotonic_s() - asked_s_ - patience_s_;
    return Taken{.sample = sample_.load(), .age_s = late_s > 0.0 ? late_s : 0.0};
  }

  /// Refused: the device did not take an earlier order. This one is on its way all the same.
  outcome::Result<void> write(const Order& order) noexcept {
    // Looked at first: the thread may refuse this order before write() has returned.
    const bool earlier_refused = unwritten_.exchange(false);
    order_.store(order);
    ordered_.store(true);
    wake_.post();
    if (!earlier_refused) {
      return {};
    }
    const std::scoped_lock lock(telling_);
    return std::unexpected(write_fault_);
  }

 private:
  void run() {
    while (!ends_.load()) {
      wake_.wait(-1.0);
      // Looked at first: an order that was left before the question is there then.
      const bool asked = asked_.exchange(false);
      if (ordered_.exchange(false)) {
        tell(device_->write(order_.load()), unwritten_, write_fault_);
      }
      if (asked) {
        Sample sample{};
        const auto got = device_->read(sample);
        sample_.store(sample);
        faulty_.store(false);
        tell(got, faulty_, fault_);
        answered_.post();
      }
    }
  }
  void tell(const outcome::Result<void>& done, std::atomic<bool>& flag, outcome::Refusal& words) {
    if (!done) {
      const std::scoped_lock lock(telling_);
      words = done.error();
      flag.store(true);
    }
  }

  std::string name_;
  std::unique_ptr<Device<Sample, Order>> device_;
  double patience_s_;
  bool waiting_ = false;  ///< for an answer; of the port's thread, as `asked_s_`
  double asked_s_ = 0.0;
  rt::Snapshot<Order> order_;
  rt::Snapshot<Sample> sample_;
  std::atomic<bool> ordered_{false};
  std::atomic<bool> asked_{false};
  std::atomic<bool> faulty_{false};     ///< there is no sample
  std::atomic<bool> unwritten_{false};  ///< an order was not taken, and nobody was told
  std::atomic<bool> ends_{false};
  std::mutex telling_;  ///< the refusals' words
  outcome::Refusal fault_;
  outcome::Refusal write_fault_;
  Event wake_;
  Event answered_;
  std::thread thread_;  ///< last: it uses the others
};

}  // namespace steadyrest::kernel::link
