// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/live_page/past_runs/event_words.hpp>
#include <steadyrest/live/wish/wish_words.hpp>

namespace steadyrest::apps::live_page::past_runs {

std::string event_words(const record::Event& event) {
  switch (event.kind) {
    case record::EventKind::reload:
      return "another machine file took over";
    case record::EventKind::wish:
      return steadyrest::live::wish_words(event.text);
    default:
      return event.text;
  }
}

}  // namespace steadyrest::apps::live_page::past_runs
