// SPDX-License-Identifier: Apache-2.0
#include <steadyrest/apps/page/chatter/chatter_page.hpp>

// The head of every chatter page; `answer` is what --json prints, so page and script never differ.
namespace steadyrest::apps::page {

Json chatter_head(std::string_view kind, std::string_view process, const Json& answer) {
  Json page = page_head("steadyrest-chatter/1");
  page.update({{"kind", kind}, {"process", process}, {"answer", answer}});
  return page;
}

}  // namespace steadyrest::apps::page
