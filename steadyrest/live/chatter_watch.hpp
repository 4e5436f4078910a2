// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <steadyrest/live/live_status.hpp>
#include <steadyrest/supervisor/supervisor.hpp>

namespace steadyrest::live {

/// Follows what the layer hears: how often and how long it chattered, and how loud it was before
/// the layer stepped in.
///
/// `before` is the highest level from the beginning of the chatter until the spindle, as the
/// control reports it, runs at the better speed (1 % of it); known once that speed has been asked
/// for in mode act. It stays until the request ends or chatter begins at another speed. In the
/// cycle: no allocation.
class ChatterWatch {
 public:
  const LiveChatter& update(const supervisor::Supervisor& layer, double cycle_s) noexcept;

 private:
  LiveChatter now_;
  bool heard_ = false;
  double loudest_ = 0.0;  ///< of this chatter
  bool arrived_ = false;  ///< the spindle runs at the better speed
};

}  // namespace steadyrest::live
