// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <steadyrest/kernel/override/arbiter.hpp>
#include <steadyrest/live/chatter_watch.hpp>

namespace steadyrest::live {
namespace {

using Kind = chatter::online::Detector::Kind;

constexpr double kSameRatio = 0.01;
/// Of the threshold: lines of less energy come and go with the noise.
constexpr double kLineShown = 0.5;

/// In the cut alone: outside, the ear keeps its last word.
void show_line(const chatter::online::BetterSpeed::Output& heard, bool cuts,
               LiveChatter& now) noexcept {
  const bool stands_out = now.chatters || now.level >= kLineShown * heard.threshold;
  const bool shown = cuts && stands_out && heard.line.frequency_hz > 0.0;
  now.line = shown ? heard.line : chatter::online::OrderGate::Output{};
  now.forced = now.line.forced && !now.chatters;
  now.mode_hz = shown ? heard.mode_hz : 0.0;
  now.confidence = now.chatters ? heard.confidence : 0.0;
  now.speed_rev_s = cuts ? heard.speed_rev_s : 0.0;
  now.speed_sd = cuts ? heard.speed_sd : 0.0;
  now.clips = heard.clips;
}

}  // namespace

const LiveChatter& ChatterWatch::update(const supervisor::Supervisor& layer,
                                        double cycle_s) noexcept {
  const auto& heard = layer.estimates().heard;
  now_.listens = heard.has_value();
  if (!heard) {
    return now_;
  }
  const kernel::signal::Frame& frame = layer.frame();
  const bool begins = heard->chatter && !heard_;
  heard_ = heard->chatter;
  // Outside of cuts the ear keeps its last word, and there is no chatter.
  const bool cuts = frame.motion == kernel::signal::Motion::feed;
  now_.chatters = heard->chatter && cuts;
  now_.kind = heard->kind;
  now_.frequency_hz = heard->frequency_hz;
  // Of a tool that is too quiet to be in a cut the share says nothing.
  now_.level = cuts && heard->kind != Kind::none ? heard->level : 0.0;
  now_.threshold = heard->threshold;
  show_line(*heard, cuts, now_);
  const bool asks = kernel::override::is_wish(heard->request.ratio, heard->request.reason);
  now_.better_ratio = asks ? heard->request.ratio : 1.0;
  now_.events += begins ? 1 : 0;
  now_.chatter_s += now_.chatters ? cycle_s : 0.0;
  const bool there =
      asks && std::abs(frame.spindle.effective_ratio - heard->request.ratio) < kSameRatio;
  if (begins && !there) {
    loudest_ = 0.0;
    arrived_ = false;
  }
  arrived_ = arrived_ || there;
  if (now_.chatters && !arrived_) {
    loudest_ = std::max(loudest_, heard->level);
  }
  const bool steps_in = asks && layer.in_force().written;
  now_.before = steps_in ? loudest_ : 0.0;
  return now_;
}

}  // namespace steadyrest::live
