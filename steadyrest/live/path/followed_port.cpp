// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <steadyrest/live/path/followed_port.hpp>
#include <steadyrest/math/geometry/segment.hpp>

// The cycle says which route it looks at before it looks; a route is freed when it is neither that
// one nor the newest.
namespace steadyrest::live {

namespace {

/// As a control would show it that knows where it is.
void show_path(kernel::signal::Frame& frame) noexcept {
  const auto& segment = frame.path[frame.path_index];
  const double u = math::geometry::parameter_at(
      segment, std::clamp(frame.path_position_mm - segment.position_mm, 0.0, segment.length_mm));
  const kernel::signal::Point on_path = math::geometry::point_at(segment, u);
  for (std::size_t i = 0; i < on_path.size(); ++i) {
    frame.axis.at(i).command_mm = on_path.at(i) + frame.axis.at(i).offset_mm;
  }
  frame.program_line = segment.line;
  frame.programmed_feed_mm_s = segment.feed_mm_s;
  if (frame.motion == kernel::signal::Motion::feed) {
    frame.motion = segment.motion;
  }
}

}  // namespace

using kernel::outcome::Result;
using kernel::signal::Frame;
using kernel::signal::Motion;
using nc::follow::Place;

Result<Frame> FollowedPort::read() noexcept {
  auto frame = machine_.read();
  if (!frame) {
    return frame;
  }
  take();
  const auto found = locator_.update(*frame);
  place_.store(found.place);
  frame->path = {};
  frame->original = {};
  if (found.place == Place::on_path) {
    frame->path = now_->path();
    frame->original = now_->original();
    frame->path_index = found.index;
    frame->path_position_mm = found.position_mm;
    if (estimated_) {
      show_path(*frame);
    }
    // A control may show a short thread late, or not at all.
    const Motion planned = frame->path[found.index].motion;
    if (is_locked(planned) && frame->motion != Motion::idle) {
      frame->motion = planned;
    }
  }
  show_text(*frame);
  return frame;
}

void FollowedPort::show_text(Frame& frame) const noexcept {
  const bool runs = frame.program != kernel::signal::ProgramState::stopped;
  frame.heat_in_text = runs && heat_in_text_.load();
  frame.original_unknown =
      runs && (original_unknown_.load() || (path_in_text_.load() && frame.original.empty()));
}

void FollowedPort::tell(const InText& in_text) noexcept {
  path_in_text_.store(in_text.path);
  original_unknown_.store(in_text.path_unknown);
  heat_in_text_.store(in_text.heat);
}

void FollowedPort::take() noexcept {
  const Route* const route = offered_.load();
  if (route == now_) {
    return;
  }
  locator_.follow(nullptr);
  now_ = nullptr;
  used_.store(route);
  if (offered_.load() == route) {
    now_ = route;
    locator_.follow(route);
  }
}

void FollowedPort::offer(std::shared_ptr<const Route> route) {
  offered_.store(route.get());
  const Route* const used = used_.load();
  std::erase_if(kept_, [&](const auto& kept) { return kept.get() != used; });
  if (route) {
    kept_.push_back(std::move(route));
  }
}

}  // namespace steadyrest::live
