// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <list>
#include <string>
#include <unordered_map>

namespace steadyrest::web {

/// A connection, as far as others may need its place. In the traffic's thread alone.
class Guest {
 public:
  Guest() = default;
  Guest(const Guest&) = delete;
  Guest& operator=(const Guest&) = delete;
  virtual ~Guest() = default;
  /// Closes it. Its seat is gone when this returns.
  virtual void give_way() = 0;
};

/// The places of connections, and which one goes when all are taken.
///
/// Only a connection that waits for its client gives way: for what the client sends next, or for it
/// to take what it is sent. It is one of the address that has the most connections, and of those
/// the one that has not moved for longest; nobody gives way to an address with more connections
/// than its own. So one address cannot shut others out, whatever it does with its connections.
///
/// A few places more are kept: a connection that finds all others busy gets one of these, for
/// urgent requests alone.
class Guests {
  using ByAddress = std::unordered_map<std::string, std::size_t>;  ///< how many connections
  struct Entry {
    ByAddress::value_type* address = nullptr;
    bool kept = false;
    bool waits = false;
    Guest* guest = nullptr;
  };
  using Entries = std::list<Entry>;  ///< the one that has not moved for longest is first

 public:
  /// A connection's place; it is free again when this goes.
  class Seat {
   public:
    Seat(Guests& guests, const std::string& address, bool kept, Guest& guest);
    Seat(const Seat&) = delete;
    Seat& operator=(const Seat&) = delete;
    ~Seat();

    /// For its client, from now on; or the client has sent or taken something.
    void waits();
    /// For its answer: it keeps its place.
    void works() { at_->waits = false; }
    [[nodiscard]] bool is_kept() const noexcept { return at_->kept; }

   private:
    Guests& guests_;
    Entries::iterator at_;
  };

  Guests(std::size_t most, std::size_t most_kept) : most_(most), most_kept_(most_kept) {}

  enum class Place { none, any, kept };
  /// For a connection from there; another one may have given way.
  [[nodiscard]] Place find(const std::string& address);
  [[nodiscard]] Place find_kept(const std::string& address);

 private:
  bool make_room(const std::string& address, bool kept);

  std::size_t most_;
  std::size_t most_kept_;
  std::size_t kept_ = 0;  ///< in kept places
  Entries entries_;
  ByAddress by_address_;
};

}  // namespace steadyrest::web
