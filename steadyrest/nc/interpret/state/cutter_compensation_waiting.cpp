// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/nc/interpret/state/cutter_compensation.hpp>

// The moves and events waiting for the next move, and how they go out.
namespace steadyrest::nc::interpret {

CutterCompensation::Fault CutterCompensation::wait(const Move& move, PlanePoint direction,
                                                   double angle) {
  // Bounds the memory: a program may have any number of blocks without a move in the plane.
  if (waiting_.size() >= kMostWaiting || overflow_) {
    return Fault::too_many_waiting;
  }
  // The corner at a stop lies before the first move in the plane after it; later corners are free
  // again.
  const bool turns_corner =
      move.kind == MoveKind::arc || direction.first != 0.0 || direction.second != 0.0;
  stopped_ = stopped_ && !turns_corner;
  waiting_.emplace_back(
      WaitingMove{.move = move, .direction = direction, .angle = angle, .in_plane = true});
  return Fault::none;
}

void CutterCompensation::on_move(const Move& move) {
  if (waiting_.empty()) {
    send(move);
  } else if (waiting_.size() < kMostWaiting) {
    waiting_.emplace_back(
        WaitingMove{.move = move, .direction = {}, .angle = 0.0, .in_plane = false});
  } else {
    overflow_ = true;
  }
}

void CutterCompensation::on_event(const Event& event) {
  if (event.kind == EventKind::end) {
    release();
  }
  if (waiting_.empty()) {
    out_->on_event(event);
  } else if (waiting_.size() < kMostWaiting) {
    waiting_.emplace_back(event);
  } else {
    overflow_ = true;
  }
}

void CutterCompensation::release() {
  for (const Waiting& one : waiting_) {
    if (const auto* const event = std::get_if<Event>(&one); event != nullptr) {
      out_->on_event(*event);
    } else {
      send(std::get<WaitingMove>(one).move);
    }
  }
  waiting_.clear();
}

// A lathe tool's point lies off the centre of its nose.
void CutterCompensation::send(const Move& move) {
  Move out = move;
  if (active() && out.kind != MoveKind::dwell) {
    constexpr auto kShift = [](int orientation, int a, int b, int c, int x, int y, int z) {
      return orientation == a || orientation == b || orientation == c   ? -1.0
             : orientation == x || orientation == y || orientation == z ? 1.0
                                                                        : 0.0;
    };
    // Orientation of a lathe tool's nose as in LinuxCNC's tool table: 1 to 4 are the corners, 5 to
    // 8 the sides of the nose circle where the tool point lies; 0 and 9 are its centre.
    if (lathe_) {
      const double shift_x = tool_.radius_mm * kShift(tool_.orientation, 1, 2, 6, 3, 4, 8);
      const double shift_z = tool_.radius_mm * kShift(tool_.orientation, 2, 3, 7, 1, 4, 5);
      out.end[0] += shift_x;
      out.end[2] += shift_z;
      out.centre_mm[0] += out.kind == MoveKind::arc ? shift_x : 0.0;
      out.centre_mm[2] += out.kind == MoveKind::arc ? shift_z : 0.0;
    }
  }
  // Starts come from the contour: a move going out starts where the last one ended.
  if (out.kind == MoveKind::dwell) {
    out.end = machine_;
  }
  out.start = machine_;
  // An arc's centre lies at the height of its start, which the previous move may have changed.
  if (out.kind == MoveKind::arc) {
    out.centre_mm[axes_.normal] = machine_[axes_.normal];
  }
  machine_ = out.end;
  out_->on_move(out);
}

}  // namespace steadyrest::nc::interpret
