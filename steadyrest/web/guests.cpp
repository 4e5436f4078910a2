// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/web/guests.hpp>

namespace steadyrest::web {

Guests::Seat::Seat(Guests& guests, const std::string& address, bool kept, Guest& guest)
    : guests_(guests) {
  ByAddress::value_type& has = *guests.by_address_.try_emplace(address, 0).first;
  ++has.second;
  guests.kept_ += kept ? 1 : 0;
  at_ = guests.entries_.insert(guests.entries_.end(),
                               {.address = &has, .kept = kept, .guest = &guest});
}

Guests::Seat::~Seat() {
  if (--at_->address->second == 0) {
    guests_.by_address_.erase(guests_.by_address_.find(at_->address->first));
  }
  guests_.kept_ -= at_->kept ? 1 : 0;
  guests_.entries_.erase(at_);
}

void Guests::Seat::waits() {
  at_->waits = true;
  guests_.entries_.splice(guests_.entries_.end(), guests_.entries_, at_);
}

Guests::Place Guests::find(const std::string& address) {
  if (entries_.size() - kept_ < most_ || make_room(address, false)) {
    return Place::any;
  }
  return find_kept(address);
}

Guests::Place Guests::find_kept(const std::string& address) {
  return kept_ < most_kept_ || make_room(address, true) ? Place::kept : Place::none;
}

bool Guests::make_room(const std::string& address, bool kept) {
  const auto own = by_address_.find(address);
  const std::size_t least = own == by_address_.end() ? 1 : own->second;
  const Entry* goes = nullptr;
  for (const Entry& entry : entries_) {
    // Of two addresses with as many, the one whose connection has not moved for longer.
    const std::size_t has = entry.address->second;
    if (entry.waits && entry.kept == kept && has >= least &&
        (goes == nullptr || has > goes->address->second)) {
      goes = &entry;
    }
  }
  if (goes != nullptr) {
    goes->guest->give_way();
  }
  return goes != nullptr;
}

}  // namespace steadyrest::web
